"""run.sh measures parts into a folder, their rows become a small CSV and tables, and the committed CSVs are good.

Usage: results_test.py FOLDER_OF_PROGRAMS
"""
import glob
import os
import subprocess
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "tests", "benchmarks"))
from programs import PROGRAMS, ROOT, ProgramTest, read_csv

STUDY = os.path.join(ROOT, "study")


class Run(ProgramTest):
    def run_study(self, *arguments):
        return subprocess.run(["bash", os.path.join(STUDY, "run.sh"), "--bin", PROGRAMS, "--quick", "--repeats", "2",
                               *arguments, self.path("out")], capture_output=True, text=True, timeout=600)

    def test_parts_can_be_measured_one_after_the_other(self):
        result = self.run_study("--parts", "refit,peers", "--only", "sphere_1k")
        self.assertEqual(result.returncode, 0, result.stderr)
        result = self.run_study("--parts", "quality", "--only", "sphere_1k")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = read_csv(self.path("out/study.csv"))
        self.assertLessEqual({"construction", "refit", "quality"}, {row["part"] for row in rows})
        self.assertIn("fcl", {row["backend"] for row in rows})
        self.assertIn("front over simple traversal", self.read("out/tables.md"))

    def test_unknown_options_are_refused(self):
        self.assertEqual(self.run_study("--nonsense").returncode, 2)


class Reduced(ProgramTest):
    @staticmethod
    def step(step, time, **cells):
        return {"part": "traversal", "model": "thesis", "variant": "v", "backend": "host", "device": "host",
                "threads": 1, "triangles": 5, "step": step, "phase": "rest", "broad_ms": time, "step_ms": 2 * time,
                "hash": "h", "valid": "yes", **cells}

    def reduce(self, *rows):
        self.write_results("raw/study_x.json", rows)
        result = self.script("study/reduce.py", self.path("raw"), self.path("m.csv"))
        return result.returncode, read_csv(self.path("m.csv"))

    def test_steps_become_their_mean_without_the_first(self):
        code, rows = self.reduce(self.step(0, 9.0), self.step(1, 1.0), self.step(2, 2.0))
        self.assertEqual((code, [(row["broad_ms"], row["median_ms"]) for row in rows]), (0, [("1.5", "3")]))

    def test_rows_measured_anew_replace_old_ones_and_void_rows_are_left_out(self):
        refit = {"part": "refit", "model": "m", "variant": "v", "backend": "host", "median_ms": 1.0, "hash": "h",
                 "dop": 18}
        self.reduce(refit, {**refit, "model": "n"})
        code, rows = self.reduce({**refit, "median_ms": 2.0}, {**refit, "model": "n", "valid": "no"})
        self.assertEqual(code, 3)
        self.assertEqual([(row["model"], row["median_ms"]) for row in rows], [("n", "1"), ("m", "2")])


CSVS = sorted(glob.glob(os.path.join(STUDY, "results", "*.csv")))


class Committed(ProgramTest):
    def test_every_row_has_a_hash_and_a_commit(self):
        self.assertTrue(CSVS)
        for path in CSVS:
            seen = set()
            for row in read_csv(path):
                self.assertRegex(row["hash"], "^[0-9a-f]{16}$", row)
                self.assertRegex(row["commit"], "^[0-9a-f]{7}$", row)
                identity = tuple(row[name] for name in ("part", "model", "variant", "phase", "level", "stage",
                                                        "backend", "threads",
                                                        "dop", "pairs"))
                self.assertNotIn(identity, seen, "twice")
                seen.add(identity)

    def test_peers_refitted_to_the_moved_mesh(self):
        """A peer's tree after its refit is of the sheared mesh, everywhere, and not the tree that was built."""
        for path in CSVS:
            peers = [row for row in read_csv(path) if row["backend"] in ("embree", "fcl")]
            built = {(row["model"], row["variant"], row["threads"]): row["hash"] for row in peers
                     if row["part"] == "construction"}
            self.assertTrue(built)
            for row in peers:
                if row["part"] == "refit":
                    self.assertNotEqual(row["hash"], built[row["model"], row["variant"], row["threads"]], row)

    def test_findings_have_the_tables_of_the_data(self):
        result = self.script("study/report.py", *CSVS, "--tables", self.path("tables.md"))
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(os.path.join(STUDY, "FINDINGS.md")) as file:
            findings = file.read().splitlines()
        for line in self.read("tables.md").splitlines():
            if line.startswith("|"):
                self.assertIn(line, findings)


if __name__ == "__main__":
    unittest.main()
