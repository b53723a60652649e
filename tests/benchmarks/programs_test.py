"""The program bench_step runs, its tables parse, and a wrong hash voids a row.

Usage: programs_test.py FOLDER_OF_PROGRAMS
"""
import os
import unittest

from programs import ProgramTest, read_csv, run


class BenchStep(ProgramTest):
    def test_rows_of_every_method(self):
        rows = self.quick("bench_step")
        steps = {}
        for row in rows:
            if row["stage"] == "step":
                steps.setdefault(row["scene"], {})[row["method"]] = row
        self.assertEqual(set(steps), {"quick_one", "quick_many", "quick_self"})
        for scene, methods in steps.items():
            peers = () if scene == "quick_self" else ("fcl_pairs", "fcl_collide")
            self.assertEqual("fcl_pairs" in methods, bool(peers))
            for name in ("drape_host", "embree_contacts_1", "embree_contacts_2", "embree_pairs_1") + peers:
                row = methods[name]
                self.assertLessEqual(0, float(row["min_ms"]))
                self.assertLessEqual(float(row["min_ms"]), float(row["median_ms"]))
                self.assertLessEqual(float(row["median_ms"]), float(row["p95_ms"]))
                self.assertGreater(float(row["candidates"]), 0)
            reference = methods["drape_host"]
            self.assertGreater(float(reference["contacts"]), 100)
            for row in methods.values():
                self.assertNotEqual(row["valid"], "no")
                if row["valid"] == "yes":
                    self.assertEqual(row["hash"], reference["hash"])
                    self.assertEqual(row["contacts"], reference["contacts"])
            if not peers:
                self.assertEqual(methods["embree_contacts_1"]["valid"], "yes")

    def test_the_parts_of_a_whole_step_add_up(self):
        rows = self.quick("bench_step", "--backend", "host", "--method", "drape_world_host")
        for scene in ("quick_one", "quick_many"):
            mine = {row["stage"]: row for row in rows if (row["scene"], row["method"]) == (scene, "drape_world_host")}
            parts = [row for stage, row in mine.items() if stage.startswith("part: ")]
            self.assertGreater(float(mine["step"]["contacts"]), 100)
            self.assertGreater(sum(float(part["median_ms"]) for part in parts), 0.5 * float(mine["step"]["median_ms"]))
            self.assertLessEqual(sum(float(part["min_ms"]) for part in parts), float(mine["step"]["min_ms"]) + 1e-4)

    def test_an_opencl_device_gives_the_hosts_hash(self):
        rows = self.quick("bench_step", "--backend", "opencl", "--method", "drape", "--method", "drape_kernels")
        for name in ("drape", "drape_kernels"):
            mine = [row for row in rows if row["method"] == name]
            self.assertTrue(mine, "no rows of " + name)
            self.assertTrue(all(row["valid"] in ("yes", "") for row in mine))
            self.assertTrue(any(row["valid"] == "yes" for row in mine))
        self.assertTrue(any(row["stage"].startswith("kernel: narrowPhase") for row in rows))
        self.assertEqual({row["scene"] for row in rows if row["stage"] == "kernel: selfCull"}, {"quick_self"})
        self.assertTrue(any(row["stage"] == "memory: cloth triangles" and int(row["bytes"]) > 0 for row in rows))

    def test_a_wrong_hash_voids_the_row(self):
        self.quick("bench_step", "--backend", "host", "--method", "embree_contacts_1")
        result = run("bench_step", "--quick", "--backend", "host", "--method", "embree_contacts_1", "--csv",
                     self.path("void.csv"), "--reference", self.reference_with_other_hash())
        self.assertEqual(result.returncode, 3, result.stderr)
        rows = read_csv(self.path("void.csv"))
        self.assertTrue(rows)
        for row in rows:
            self.assertEqual(row["valid"], "no")
            self.assertEqual(row.get("median_ms", ""), "")

    def test_the_same_reference_is_good(self):
        self.quick("bench_step", "--backend", "host", "--method", "drape_host")
        os.rename(self.path("rows.json"), self.path("before.json"))
        rows = self.quick("bench_step", "--backend", "host", "--method", "embree_contacts_1", "--reference",
                          self.path("before.json"))
        self.assertEqual({row["method"] for row in rows}, {"embree_contacts_1"}, "the host is not run again")
        self.assertTrue(all(row["valid"] == "yes" for row in rows))

    def test_bad_input_is_refused(self):
        for arguments in (["--scene", "no_such_scene"], ["--backend", "abacus"], ["--repeats", "0"],
                          ["--reference", self.path("missing.json")]):
            result = run("bench_step", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertTrue(result.stderr)

    def test_unknown_names_are_refused_with_those_there_are(self):
        self.refused("bench_step", ["--quick", "--scene", "quick_one", "--scene", "nosuch"], "nosuch", "quick_one")
        self.refused("bench_step", ["--quick", "--method", "drape_host", "--method", "nosuch"], "nosuch",
                     "embree_pairs_1")

    def test_a_reference_that_is_none_is_refused(self):
        for text in ("", "[]", '{"rows": [7]}', '{"rows": [{"valid": "yes"}]}'):
            with open(self.path("none.json"), "w") as file:
                file.write(text)
            self.refused("bench_step", ["--quick", "--reference", self.path("none.json")], "none.json")


class CommandLines(ProgramTest):
    PROGRAMS = ("bench_step", "error_vs_time")

    def test_the_version_is_told(self):
        for program in self.PROGRAMS:
            result = run(program, "--version")
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertRegex(result.stdout, r"^\w+ \(Drape\) \d+\.\d+\.\d+\n$")

    def test_mistakes_are_told_with_what_is_meant(self):
        for program in self.PROGRAMS:
            self.refused(program, ["--qiuck"], "no option --qiuck", "did you mean --quick?")
            self.refused(program, ["--backend", "hots"], "--backend", "did you mean host?")
            self.refused(program, ["--csv", "--quick"], "--csv needs a value", "option --quick follows")
        self.refused("bench_step", ["--scene", "thesos"], "--scene", "did you mean thesis?")
        self.refused("bench_step", ["--method", "embree_pair_1"], "--method", "did you mean embree_pairs_1?")
        self.refused("error_vs_time", ["--part", "simulatoin"], "--part", "did you mean simulation?")
        self.refused("error_vs_time", ["--scene", "stiars"], "--scene", "did you mean stairs?")


if __name__ == "__main__":
    unittest.main()
