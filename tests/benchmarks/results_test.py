"""Raw results become a small CSV, the CSV becomes tables and plots, and the committed CSVs are good.

Usage: results_test.py FOLDER_OF_PROGRAMS
"""
import glob
import os
import unittest

from programs import ROOT, ProgramTest, read_csv


class Reduced(ProgramTest):
    """reduce.py on rows that are made here."""

    @staticmethod
    def row(**cells):
        return {"scene": "thesis", "sweep": "", "method": "drape_host", "stage": "step", "device": "host",
                "cloth_triangles": 2, "obstacle_triangles": 3, "min_ms": 1.0, "median_ms": 2.0, "p95_ms": 3.0,
                "hash": "0123456789abcdef", "valid": "yes", **cells}

    def reduce(self, *rows, **machine):
        self.write_results("raw/bench_step.json", rows, **machine)
        result = self.script("benchmarks/reduce.py", self.path("raw"), self.path("m.csv"))
        return result.returncode, result.stdout + result.stderr

    def cells(self, column):
        return [row[column] for row in read_csv(self.path("m.csv"))]

    def test_new_rows_replace_old_rows_of_their_scene_and_method(self):
        self.assertEqual(self.reduce(self.row(), self.row(scene="fine")), (0, ""))
        self.assertEqual(self.reduce(self.row(median_ms=4.0), self.row(method="drape"), commit="def5678"), (0, ""))
        self.assertEqual(self.cells("scene"), ["fine", "thesis", "thesis"])
        self.assertEqual(self.cells("median_ms"), ["2", "4", "2"])
        self.assertEqual(self.cells("commit"), ["abc1234", "def5678", "def5678"])

    def test_rows_that_no_table_uses_are_left_out(self):
        self.reduce(self.row(), self.row(stage="submit"), self.row(method="drape_kernels", stage="kernel: patchCull"),
                    self.row(sweep="cloth", method="fcl_collide"))
        self.assertEqual(self.cells("stage"), ["step"])

    def test_memory_is_summed(self):
        self.reduce(self.row(), self.row(stage="memory: cloth edges", bytes=3),
                    self.row(stage="memory: unsorted contacts", bytes=4))
        self.assertEqual(self.cells("bytes"), ["7"])

    def test_void_rows_are_named_and_left_out(self):
        code, said = self.reduce(self.row(), self.row(scene="fine", valid="no"))
        self.assertEqual((code, self.cells("scene")), (3, ["thesis"]))
        self.assertIn("fine", said)

    def test_another_machine_is_refused(self):
        self.reduce(self.row())
        code, said = self.reduce(self.row(median_ms=9.0), processor="q")
        self.assertEqual((code, self.cells("median_ms")), (2, ["2"]))
        self.assertIn("several machines", said)


class Reports(ProgramTest):
    def test_tables_and_plots_of_a_quick_run(self):
        self.quick("bench_step")
        os.makedirs(self.path("raw"))
        os.rename(self.path("rows.json"), self.path("raw/bench_step.json"))
        self.assertEqual(self.script("benchmarks/reduce.py", self.path("raw"), self.path("m.csv")).returncode, 0)
        rows = read_csv(self.path("m.csv"))
        self.assertEqual({row["scene"] for row in rows}, {"quick_one", "quick_many", "quick_self"})
        self.assertEqual(self.script("benchmarks/report.py", self.path("m.csv")).returncode, 0)
        self.assertTrue(self.read("m.md").startswith("# m\n"))

    def test_plots_of_the_committed_results(self):
        try:
            import matplotlib  # noqa: F401
        except ModuleNotFoundError:
            self.skipTest("python3-matplotlib is not installed")
        result = self.script("benchmarks/report.py", *CSVS, "--out", self.folder, "--plots", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        for path in CSVS:
            self.assertIn("</svg>", self.read(os.path.basename(path)[:-4] + "_steps.svg"))


class Hashes(ProgramTest):
    """Trajectories of several machines."""

    def report(self, *machines):
        """machines: cells of the one row of each. Returns the exit code and the message."""
        names = []
        for index, cells in enumerate(machines):
            names.append(self.path(f"{index}.csv"))
            row = {"machine": "m", "commit": "abc1234", "program": "cloth_drop", "scene": "o 1", "setting": "",
                   "method": "drape", "stage": "collision", "device": "gpu", "steps": "240", "penetration_mm": "0",
                   "ended": "whole", "hash": "1", **cells}
            with open(names[-1], "w") as file:
                file.write(",".join(row) + "\n" + ",".join(row.values()) + "\n")
        result = self.script("benchmarks/report.py", *names)
        self.assertEqual(os.path.exists(self.path("0.md")), result.returncode == 0,
                         "no table of results that are refused")
        return result.returncode, result.stderr

    def test_one_trajectory_with_two_hashes_is_refused(self):
        code, said = self.report({}, {"hash": "2", "method": "drape_host", "device": "host"})
        self.assertEqual(code, 1)
        for words in ("abc1234", "1 (0, drape)", "2 (1, drape_host)"):
            self.assertIn(words, said)

    def test_other_runs_may_differ(self):
        for other in ({"commit": "abc1235"}, {"scene": "o 2"}, {"setting": "all contacts"}, {"steps": "52"},
                      {"method": "bullet_stock"}, {"commit": "abc1234-dirty"}):
            with self.subTest(**other):
                self.assertEqual(self.report({}, {"hash": "2", **other})[0], 0)


CSVS = sorted(glob.glob(os.path.join(ROOT, "benchmarks", "results", "*.csv")))


class Committed(ProgramTest):
    def test_every_answer_has_a_hash_and_a_commit(self):
        self.assertTrue(CSVS)
        for path in CSVS:
            seen = set()
            for row in read_csv(path):
                self.assertRegex(row["commit"], "^[0-9a-f]{7}$", row)
                identity = tuple(row[name] for name in ("program", "scene", "setting", "method", "stage", "device"))
                self.assertNotIn(identity, seen, "twice")
                seen.add(identity)
                if row["program"] == "bench_step" and row["method"].startswith(("drape", "embree_contacts")):
                    self.assertRegex(row["hash"], "^[0-9a-f]{16}$", row)

    def test_summaries_are_those_of_the_data(self):
        result = self.script("benchmarks/report.py", *CSVS, "--out", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        for path in CSVS:
            with open(path[:-4] + ".md") as file:
                self.assertEqual(file.read(), self.read(os.path.basename(path)[:-4] + ".md"))


if __name__ == "__main__":
    unittest.main()
