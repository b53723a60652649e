"""The package's annotations are consistent, so that an app's type checker can rely on them."""
import pathlib
import subprocess
import sys

import pytest

import drape


def test_mypy_accepts_the_package(tmp_path):
    pytest.importorskip("mypy")
    package = pathlib.Path(drape.__file__).parent
    result = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-warn-return-any", "--cache-dir", tmp_path, package],
        capture_output=True, text=True)
    assert result.returncode == 0, result.stdout
