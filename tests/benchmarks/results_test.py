"""Results of the study that were measured in parts become one, and those that are published are good.

Usage: results_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import shutil
import subprocess
import unittest

from programs import PROGRAMS, ProgramTest, read_csv


class Merge(ProgramTest):
    """Results of parts become one, whatever the order they were measured in."""

    def study(self, name, rows, **machine):
        content = {"machine": {"date": "2026-01-01", "commit": "a", "processor": "p", "cores": 2, "devices": [], **machine},
                   "rows": rows}
        with open(self.path(name), "w") as file:
            json.dump(content, file)
        return self.path(name)

    def merged(self):
        with open(self.path("out/study.json")) as file:
            return json.load(file)

    def merge(self, *names):
        return self.script("merge_study.py", self.path("out"), *names)

    def test_parts_join_and_newer_ones_replace(self):
        host = {"part": "construction", "model": "m", "backend": "host", "triangles": 5, "valid": "yes",
                "hash": "h"}
        refit = {**host, "part": "refit", "median_ms": 1.0}
        first = self.study("first.json", [refit, {**host, "variant": "x", "median_ms": 1.0}, {**host, "variant": "gone"}])
        self.assertEqual(self.merge(first).returncode, 0)
        small = {**host, "model": "s", "triangles": 3}
        device = {**host, "backend": "opencl"}
        second = self.study("second.json", [device, {**host, "variant": "x", "median_ms": 2.0}, small], commit="b")
        self.assertEqual(self.merge(second).returncode, 0)
        b = {"commit": "b"}
        self.assertEqual(self.merged()["rows"], [{**small, **b}, {**host, **b, "variant": "x", "median_ms": 2.0},
                                                 {**device, **b}, {**refit, "commit": "a"}])
        self.assertEqual(set(self.merged()["machine"]["commit"].split(", ")), {"a", "b"})
        rows = read_csv(self.path("out/study.csv"))
        self.assertEqual([row["median_ms"] for row in rows], ["", "2", "", "1"])

    def test_another_machine_is_refused(self):
        row = {"part": "refit", "model": "m", "backend": "host", "hash": "h"}
        self.assertEqual(self.merge(self.study("first.json", [row])).returncode, 0)
        result = self.merge(self.study("second.json", [{**row, "part": "quality"}], processor="q"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("another machine", result.stderr)
        self.assertEqual(self.merged()["rows"], [{**row, "commit": "a"}])

    def test_rows_without_a_back_end_or_a_hash_are_refused(self):
        row = {"part": "refit", "model": "m", "backend": "host", "hash": "h"}
        self.assertEqual(self.merge(self.study("first.json", [row])).returncode, 0)
        for column in ("backend", "hash"):
            result = self.merge(self.study("second.json", [row, {**row, column: ""}]))
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"no {column}", result.stderr)
            self.assertEqual(len(self.merged()["rows"]), 1)

    def test_commits_that_were_replaced_are_no_longer_named(self):
        row = {"part": "refit", "model": "m", "backend": "host", "hash": "h"}
        self.assertEqual(self.merge(self.study("first.json", [row])).returncode, 0)
        self.assertEqual(self.merge(self.study("second.json", [row], commit="b")).returncode, 0)
        self.assertEqual(self.merged()["machine"]["commit"], "b")

    def test_a_void_row_is_told(self):
        void = {"part": "refit", "model": "m", "backend": "host", "hash": "h", "valid": "no"}
        self.assertEqual(self.merge(self.study("first.json", [void])).returncode, 3)

    def run_study(self, *arguments):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", "run_study.sh")
        return subprocess.run(["bash", path, "--bin", PROGRAMS, "--quick", "--repeats", "2", *arguments, self.path("out")],
                              capture_output=True, text=True, timeout=600)

    def test_parts_run_one_after_the_other(self):
        result = self.run_study("--parts", "refit,peers")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({row["part"] for row in self.merged()["rows"] if row["backend"] == "fcl"},
                         {"construction", "refit"})
        result = self.run_study("--parts", "quality", "--only", "sphere_1k")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = self.merged()["rows"]
        self.assertEqual({row["model"] for row in rows if row["part"] == "quality"}, {"sphere_1k"})
        self.assertTrue([row for row in rows if row["part"] == "refit"])
        self.assertEqual(self.run_study("--parts", "nonsense").returncode, 2)


RESULTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", "results")

# What makes a row of the study one of its own.
IDENTITY = ("part", "model", "variant", "backend", "device", "threads", "dop", "degree", "leaf_size", "kernel", "level", "step",
            "pairs")


class Committed(ProgramTest):
    """Results that are published: every row was judged, is good, and says when it was measured."""

    def machines(self):
        names = sorted(name for name in os.listdir(RESULTS) if os.path.exists(os.path.join(RESULTS, name, "study.json")))
        self.assertTrue(names)
        return names

    def test_every_row_of_the_study_has_a_good_hash(self):
        for name in self.machines():
            with open(os.path.join(RESULTS, name, "study.json")) as file:
                content = json.load(file)
            self.assertTrue(content["rows"])
            seen = set()
            for row in content["rows"]:
                identity = name, *(row.get(column) for column in IDENTITY)
                for column in ("backend", "commit"):
                    self.assertTrue(row.get(column), (identity, column))
                self.assertRegex(row.get("hash", ""), "^[0-9a-f]{16}$", identity)
                self.assertEqual(row.get("valid"), "yes", identity)
                self.assertNotIn(identity, seen, "twice")
                seen.add(identity)
            commits = {row["commit"] for row in content["rows"]}
            self.assertEqual(set(content["machine"]["commit"].split(", ")), commits)
            cells = read_csv(os.path.join(RESULTS, name, "study.csv"))
            self.assertEqual([(row["part"], row["hash"]) for row in cells],
                             [(row["part"], row["hash"]) for row in content["rows"]])

    def test_every_step_that_gives_contacts_has_a_good_hash(self):
        for name in self.machines():
            for row in read_csv(os.path.join(RESULTS, name, "bench_step.csv")):
                judged = row["method"].startswith("drape") or row["method"].startswith("embree_contacts")
                if judged and not row["stage"].startswith("memory: "):
                    self.assertRegex(row["hash"], "^[0-9a-f]{16}$", row)
                    self.assertEqual(row["valid"], "yes", row)
                self.assertNotEqual(row["valid"], "no", row)

    def test_peers_refitted_to_other_places(self):
        """A peer's tree after its refit is of the sheared mesh, everywhere, and not the one that was built."""
        refitted = {}
        for name in self.machines():
            with open(os.path.join(RESULTS, name, "study.json")) as file:
                rows = [row for row in json.load(file)["rows"] if row["backend"] in ("embree", "fcl")]
            built = {(row["model"], row["variant"], row["threads"]): row["hash"] for row in rows if row["part"] == "construction"}
            self.assertTrue(built)
            for row in (row for row in rows if row["part"] == "refit"):
                identity = row["model"], row["variant"], row["threads"]
                self.assertNotEqual(row["hash"], built[identity], identity)
                self.assertEqual(refitted.setdefault(identity, row["hash"]), row["hash"], identity)
        self.assertTrue(refitted)

    def test_one_trajectory_has_one_hash(self):
        """summary.py refuses them otherwise, here into another file."""
        shutil.copytree(RESULTS, self.path("results"), ignore=shutil.ignore_patterns("*.png"))
        shutil.copy(os.path.join(os.path.dirname(RESULTS), "README.md"), self.folder)
        result = self.script("summary.py", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("does not say its commit", result.stderr)


if __name__ == "__main__":
    unittest.main()
