"""Every suite and test that tests/tiers.cmake names exists: a pattern that matches nothing would move a test to another
tier without a word.

Usage: tiers_test.py ROOT
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(sys.argv.pop(1))


class Tiers(unittest.TestCase):
    def test_names_exist(self):
        tiers = " ".join(re.findall(r'"([^"]+)"', (ROOT / "tests/tiers.cmake").read_text()))
        names = re.findall(r"[A-Za-z]{4,}", tiers)
        self.assertGreater(len(names), 40)
        sources = "".join(path.read_text() for path in (ROOT / "tests").rglob("*.cpp"))
        for name in names:
            self.assertIn(name, sources)


if __name__ == "__main__":
    unittest.main()
