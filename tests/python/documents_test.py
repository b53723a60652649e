"""Every block of Python in docs/python.md is a program that runs, and the example does as it says."""
import pathlib
import re
import subprocess
import sys

import numpy
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUNNY = pathlib.Path("/usr/share/glmark2/models/bunny.obj")


def run(*arguments):
    return subprocess.run([sys.executable, "-B", *arguments], check=True, text=True, stdout=subprocess.PIPE).stdout


@pytest.fixture(scope="module")
def blocks():
    return re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.DOTALL | re.MULTILINE)


def test_the_world_of_the_page_runs(blocks):
    output = run("-c", blocks[0])
    assert re.search(r"^lowest node at 0\.0(19|20|21) m\n[1-9]\d* contacts in .* ms\nDrape on ", output), output


def test_the_queries_of_the_page_run(blocks):
    assert len(blocks) == 2
    assert re.search(r"^1 near, 1 intersecting\nhit at 0\.(49|50) ", run("-c", blocks[1]))


@pytest.mark.skipif(not BUNNY.exists(), reason="glmark2-data is not installed")
def test_the_example_drops_a_cloth_on_the_bunny(tmp_path):
    frames = tmp_path / "frames.npy"
    output = run(ROOT / "examples/python/drop_on_bunny.py", "--backend", "host", "--nodes", "17", "--steps", "120",
                 "--output", frames)
    assert re.search(r"2 s: [1-9]\d* of 289 nodes touch mesh 0 between heights", output), output
    assert output.endswith("\n0 pairs of triangles intersect\n")
    assert numpy.load(frames).shape == (120, 289, 3)
