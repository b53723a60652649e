"""The programs bench_step and study run, their tables parse, and a wrong hash voids a row.

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
            peers = () if scene == "quick_self" else ("fcl_pairs", "fcl_collide", "drape_host_front")
            self.assertEqual("fcl_pairs" in methods, bool(peers))
            for name in ("drape_host", "embree_contacts_1", "embree_contacts_2", "embree_pairs_1") + peers:
                row = methods[name]
                self.assertLessEqual(0, float(row["min_ms"]))
                self.assertLessEqual(float(row["min_ms"]), float(row["median_ms"]))
                self.assertLessEqual(float(row["median_ms"]), float(row["p95_ms"]))
                self.assertGreater(float(row["candidates"]), 0)
            reference = methods["drape_host"]
            self.assertGreater(float(reference["contacts"]), 100)
            reduced = methods.pop("drape_host_reduced")
            fewer = float(reduced["contacts"]) < float(reference["contacts"])
            self.assertEqual(fewer, scene != "quick_many", "where cloths are too coarse none is redundant")
            self.assertEqual(fewer, reduced["hash"] != reference["hash"])
            for row in (reduced, methods.pop("drape_reduced", reduced), methods.pop("drape_reduced_kernels", reduced)):
                self.assertEqual(row["valid"], "yes")
                self.assertEqual(row["hash"], reduced["hash"])
                self.assertEqual(row["contacts"], reduced["contacts"])
            for row in methods.values():
                self.assertNotEqual(row["valid"], "no")
                if row["valid"] == "yes":
                    self.assertEqual(row["hash"], reference["hash"])
                    self.assertEqual(row["contacts"], reference["contacts"])
            if not peers:
                self.assertEqual(methods["embree_contacts_1"]["valid"], "yes")
                continue
            # Volumes of the same kind, grown alike: the peer's pairs are those of a walk over trees.
            pairs = float(methods["fcl_pairs"]["candidates"])
            self.assertAlmostEqual(pairs / float(methods["drape_host_front"]["candidates"]), 1, delta=0.01)

    def test_an_opencl_device_gives_the_hosts_hash(self):
        rows = self.quick("bench_step", "--backend", "opencl", "--method", "drape", "--method", "drape_kernels", "--method",
                          "drape_reduced", "--method", "drape_reduced_kernels")
        for name in ("drape", "drape_kernels", "drape_reduced", "drape_reduced_kernels"):
            mine = [row for row in rows if row["method"] == name]
            self.assertTrue(mine, "no rows of " + name)
            self.assertTrue(all(row["valid"] in ("yes", "") for row in mine))
            self.assertTrue(any(row["valid"] == "yes" for row in mine))
        self.assertTrue(any(row["stage"].startswith("kernel: narrowPhase") for row in rows))
        self.assertEqual({row["method"] for row in rows if row["stage"].startswith("kernel: reduction")},
                         {"drape_reduced_kernels"})
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
        self.refused("bench_step", ["--quick", "--method", "drape_host", "--method", "nosuch"], "nosuch", "embree_pairs_1")

    def test_a_reference_that_is_none_is_refused(self):
        for text in ("", "[]", '{"rows": [7]}', '{"rows": [{"valid": "yes"}]}'):
            with open(self.path("none.json"), "w") as file:
                file.write(text)
            for program in ("bench_step", "study"):
                self.refused(program, ["--quick", "--reference", self.path("none.json")], "none.json")


class Study(ProgramTest):
    def test_every_part_has_rows(self):
        rows = self.quick("study")
        listed = run("study", "--list").stdout
        self.assertIn("traversal: ", listed)
        parts = {row["part"] for row in rows}
        for part in ("construction", "refit", "quality", "shape", "degree", "traversal", "builder", "rebuild", "triangle_tests"):
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

    def test_every_shape_of_a_tree_gives_the_same_candidates(self):
        rows = [row for row in self.quick("study", "--part", "shape") if row["part"] == "shape"]
        for model in {row["model"] for row in rows}:
            mine = [row for row in rows if row["model"] == model]
            self.assertEqual({(row["degree"], row["leaf_size"]) for row in mine},
                             {(degree, size) for degree in ("2", "4") for size in ("1", "2", "4", "8", "16")})
            self.assertEqual(len({row["hash"] for row in mine}), 1)
            self.assertTrue(all(row["valid"] == "yes" and float(row["visits"]) > 0 for row in mine))
        self.assertTrue(rows)

    def test_a_cloth_that_changes_is_rebuilt_and_one_at_rest_is_not(self):
        rows = [row for row in self.quick("study", "--part", "rebuild") if row["part"] == "rebuild"]
        rebuilds = {}
        for row in rows:
            self.assertEqual(row["valid"], "yes")
            key = row["model"], row["variant"]
            rebuilds[key] = rebuilds.get(key, 0) + int(row["rebuilds"])
        self.assertTrue(rebuilds)
        counts = {}
        for (model, variant), count in rebuilds.items():
            if "never" in variant or model.endswith("rest"):
                self.assertEqual(count, 0, (model, variant))
            else:
                name, _, decay = variant.rpartition(" ")
                counts.setdefault((model, name), []).append((float(decay), count))
        self.assertTrue(any(count > 0 for count in rebuilds.values()))
        # A higher threshold rebuilds no more often, and the highest less than the lowest somewhere.
        ordered = [[count for _, count in sorted(mine)] for mine in counts.values()]
        for mine in ordered:
            self.assertEqual(mine, sorted(mine, reverse=True))
        self.assertTrue(any(mine[0] > mine[-1] for mine in ordered))
        # Every back end in the same steps.
        for row in rows:
            if row["backend"] == "opencl":
                host = [other for other in rows if other["variant"] == "host, " + row["variant"]
                        and (other["model"], other["step"]) == (row["model"], row["step"])]
                self.assertEqual([other["rebuilds"] for other in host], [row["rebuilds"]], row)
                self.assertGreater(int(row["volume_tests"]), 0)

    def test_bad_input_is_refused(self):
        self.refused("study", ["--part", "degree", "--part", "no_such_part"], "no_such_part", "degree")


class CommandLines(ProgramTest):
    PROGRAMS = ("bench_step", "study", "study_dop6", "error_vs_time")

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
        self.refused("study", ["--part", "refti"], "--part", "did you mean refit?")
        self.refused("study", ["--only", "dargon"], "--only", "did you mean dragon?")
        self.refused("error_vs_time", ["--part", "simulatoin"], "--part", "did you mean simulation?")
        self.refused("error_vs_time", ["--scene", "stiars"], "--scene", "did you mean stairs?")


if __name__ == "__main__":
    unittest.main()
