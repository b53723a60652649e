"""The program study runs, its tables parse, and every method gives the host's result.

Usage: study_test.py FOLDER_OF_PROGRAMS
"""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "benchmarks"))
from programs import ProgramTest, run


class Study(ProgramTest):
    def test_every_part_has_rows(self):
        rows = self.quick("study")
        listed = run("study", "--list").stdout
        self.assertIn("traversal: ", listed)
        parts = {row["part"] for row in rows}
        for part in ("construction", "refit", "quality", "shape", "degree", "traversal", "builder", "triangle_tests"):
            self.assertIn(part, parts)
        for row in rows:
            self.assertEqual(row["valid"], "yes")
            self.assertTrue(row["hash"])
            for column in ("median_ms", "kernel_median_ms", "broad_ms"):
                if row.get(column):
                    self.assertGreaterEqual(float(row[column]), 0)
            if row.get("repeats") and float(row["median_ms"]) < 50:
                self.assertGreaterEqual(int(row["repeats"]), 5, row)
        self.assertTrue(any(row["repeats"] for row in rows))
        peers = {(row["variant"], row["threads"]) for row in rows if row["part"] == "construction"}
        for peer in ("embree_morton", "embree_sah", "fcl"):
            self.assertIn((peer, "1"), peers)

    def test_every_traversal_finds_the_hosts_contacts(self):
        rows = [row for row in self.quick("study", "--part", "traversal") if row["part"] == "traversal"]
        host = {row["step"]: row for row in rows if row["variant"] == "host, thesis: front"}
        self.assertTrue(host)
        self.assertGreater(len({row["contacts"] for row in host.values()}), 1, "the cloth comes down")
        for row in rows:
            self.assertEqual(row["valid"], "yes")
            self.assertEqual(row["hash"], host[row["step"]]["hash"])

    def test_the_front_tests_fewer_volumes_than_a_full_traversal(self):
        rows = self.quick("study", "--part", "traversal", "--backend", "host")
        tests = {}
        for row in rows:
            if row["phase"] == "rest":
                tests[row["variant"]] = tests.get(row["variant"], 0) + int(row["volume_tests"])
        self.assertLess(tests["host, thesis: front"], 0.75 * tests["host, as front, from the roots"])

    def test_every_builders_tree_gives_the_hosts_steps(self):
        rows = [row for row in self.quick("study", "--part", "builder") if row["part"] == "builder"]
        self.assertEqual({row["variant"] for row in rows},
                         {"host, balanced", "host, radix", "host, ploc", "host, top-down"})
        default = {row["step"]: row for row in rows if row["variant"] == "host, radix"}
        for row in rows:
            self.assertEqual((row["backend"], row["valid"]), ("host", "yes"))
            self.assertEqual(row["candidates"], default[row["step"]]["candidates"])
        # Other trees, by other tests of volumes.
        self.assertEqual(len({sum(int(row["volume_tests"]) for row in rows if row["variant"] == variant)
                              for variant in {row["variant"] for row in rows}}), 4)

    def test_every_shape_of_a_tree_gives_the_same_candidates(self):
        rows = [row for row in self.quick("study", "--part", "shape") if row["part"] == "shape"]
        for model in {row["model"] for row in rows}:
            mine = [row for row in rows if row["model"] == model]
            self.assertEqual({(row["degree"], row["leaf_size"]) for row in mine},
                             {(degree, size) for degree in ("2", "4") for size in ("1", "2", "4", "8", "16")})
            self.assertEqual(len({row["hash"] for row in mine}), 1)
            self.assertTrue(all(row["valid"] == "yes" and float(row["visits"]) > 0 for row in mine))
        self.assertTrue(rows)

    def test_bad_input_is_refused(self):
        self.refused("study", ["--part", "degree", "--part", "no_such_part"], "no_such_part", "degree")

    def test_a_reference_that_is_none_is_refused(self):
        for text in ("", "[]", '{"rows": [7]}', '{"rows": [{"valid": "yes"}]}'):
            with open(self.path("none.json"), "w") as file:
                file.write(text)
            self.refused("study", ["--quick", "--reference", self.path("none.json")], "none.json")

    def test_the_version_is_told(self):
        result = run("study", "--version")
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertRegex(result.stdout, r"^\w+ \(Drape\) \d+\.\d+\.\d+\n$")

    def test_mistakes_are_told_with_what_is_meant(self):
        self.refused("study", ["--qiuck"], "no option --qiuck", "did you mean --quick?")
        self.refused("study", ["--part", "refti"], "--part", "did you mean refit?")
        self.refused("study", ["--only", "dargon"], "--only", "did you mean dragon?")


if __name__ == "__main__":
    unittest.main()
