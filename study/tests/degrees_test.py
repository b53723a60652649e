"""Volumes of six sides give the contacts of those of eighteen. Skipped unless study_dop6 was built (study_degrees).

Usage: degrees_test.py FOLDER_OF_PROGRAMS
"""
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests", "benchmarks"))
from programs import PROGRAMS, ProgramTest, read_csv, run


@unittest.skipUnless(os.path.exists(os.path.join(PROGRAMS, "study_dop6")), "study_dop6 is not built")
class Degrees(ProgramTest):
    def degree(self, program, *arguments):
        return {(row["model"], row["variant"].partition(", ")[2], row["backend"]): row
                for row in self.quick(program, "--part", "degree", *arguments)}

    def test_volumes_of_other_degrees_give_the_same_contacts(self):
        eighteen = self.degree("study")
        os.rename(self.path("rows.json"), self.path("eighteen.json"))
        six = self.degree("study_dop6", "--reference", self.path("eighteen.json"))
        self.assertEqual(set(six), set(eighteen))
        for key, row in six.items():
            self.assertEqual((row["dop"], row["valid"]), ("6", "yes"))
            self.assertEqual(row["hash"], eighteen[key]["hash"])
            self.assertEqual(row["contacts"], eighteen[key]["contacts"])
            self.assertGreater(int(row["contacts"]), 500)
            if "default" not in key[1]:
                self.assertGreater(int(row["candidates"]), int(eighteen[key]["candidates"]))
                self.assertGreater(int(row["visits"]), int(eighteen[key]["visits"]))
            if "nodes" in row and row["nodes"]:
                self.assertLess(int(row["bytes"]), int(eighteen[key]["bytes"]))

    def test_contacts_unlike_those_of_the_reference_void_the_row(self):
        self.quick("study", "--part", "degree", "--backend", "host")
        result = run("study_dop6", "--quick", "--part", "degree", "--backend", "host", "--csv", self.path("void.csv"),
                     "--reference", self.reference_with_other_hash())
        self.assertEqual(result.returncode, 3, result.stderr)
        for row in read_csv(self.path("void.csv")):
            self.assertEqual(row["valid"], "no")
            self.assertEqual(row["dop"], "6")
            self.assertEqual(row.get("contacts", ""), "")

    def test_other_degrees_without_a_reference_are_left_out(self):
        result = run("study_dop6", "--quick", "--part", "degree", "--backend", "host", "--csv", self.path("rows.csv"))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertFalse(os.path.exists(self.path("rows.csv")))
        for model in ("sphere_1k", "terrain_6272", "quick_one"):
            self.assertIn(f"left out: {model}: ", result.stderr)
        # A reference of other models, likewise.
        self.quick("study", "--part", "degree", "--backend", "host", "--only", "sphere_1k")
        result = run("study_dop6", "--quick", "--part", "degree", "--backend", "host", "--csv", self.path("six.csv"),
                     "--reference", self.path("rows.json"))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertEqual({row["model"] for row in read_csv(self.path("six.csv"))}, {"sphere_1k"})
        self.assertIn("left out: terrain_6272: ", result.stderr)


if __name__ == "__main__":
    unittest.main()
