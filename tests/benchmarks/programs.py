"""Functions shared by the tests of the benchmark programs.

The first argument of a test is the folder of the programs.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = sys.argv.pop(1)
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def run(program, *arguments):
    return subprocess.run([os.path.join(PROGRAMS, program), *arguments], capture_output=True, text=True, timeout=600)


def read_csv(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file, strict=True))


class ProgramTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    @staticmethod
    def script(name, *arguments):
        return subprocess.run([sys.executable, os.path.join(ROOT, name), *arguments], capture_output=True, text=True,
                              timeout=600)

    def read(self, name):
        with open(self.path(name)) as file:
            return file.read()

    def write_results(self, name, rows, content=(), **machine):
        """Writes raw results as the programs do."""
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        described = {"date": "2026-01-01", "commit": "abc1234", "processor": "p", "cores": 2, "devices": [], **machine}
        with open(self.path(name), "w") as file:
            json.dump({"machine": described, "rows": rows, **dict(content)}, file)

    def path(self, name):
        return os.path.join(self.folder, name)

    def quick(self, program, *arguments):
        """Rows of a quick run; every row has every column, and JSON says the same as CSV."""
        result = run(program, "--quick", "--repeats", "2", "--csv", self.path("rows.csv"), "--json",
                     self.path("rows.json"), *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = read_csv(self.path("rows.csv"))
        with open(self.path("rows.json")) as file:
            everything = json.load(file)
        self.assertTrue(rows)
        self.assertEqual(len(rows), len(everything["rows"]))
        self.assertTrue(everything["machine"]["processor"])
        for row in rows:
            self.assertNotIn(None, row, "more cells than columns")
            self.assertNotIn(None, row.values(), "fewer cells than columns")
        return rows

    def refused(self, program, arguments, *words):
        """One line with every one of the words, and nothing measured."""
        result = run(program, *arguments)
        self.assertEqual((result.returncode, result.stdout, result.stderr.count("\n")), (2, "", 1), result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertNotIn("json.exception", result.stderr)

    def reference_with_other_hash(self):
        """The JSON of the run before, with one digit of every hash changed."""
        with open(self.path("rows.json")) as file:
            everything = json.load(file)
        for row in everything["rows"]:
            if row.get("hash"):
                row["hash"] = ("1" if row["hash"][0] == "0" else "0") + row["hash"][1:]
        with open(self.path("other.json"), "w") as file:
            json.dump(everything, file)
        return self.path("other.json")
