"""The benchmark programs run, their tables parse, and a wrong hash voids a row.

Usage: programs_test.py FOLDER_OF_PROGRAMS
"""
import csv
import json
import math
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = sys.argv.pop(1)


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
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", name)
        return subprocess.run([sys.executable, path, *arguments], capture_output=True, text=True, timeout=600)

    def path(self, name):
        return os.path.join(self.folder, name)

    def summary(self):
        """The tables of the results beside."""
        readme = self.write_readme("<!-- results: made by summary.py --><!-- end of results -->")
        result = self.script("summary.py", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("does not say its commit", result.stderr)
        with open(readme) as file:
            return file.read()

    def write_readme(self, text, folder="results"):
        path = self.path(os.path.join(folder, "README.md"))
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w") as file:
            file.write(text)
        return path

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
            reduced = methods.pop("drape_host_reduced")
            fewer = float(reduced["contacts"]) < float(reference["contacts"])
            self.assertEqual(fewer, scene != "quick_many", "where cloths are too coarse none is redundant")
            self.assertEqual(fewer, reduced["hash"] != reference["hash"])
            for row in (reduced, methods.pop("drape_reduced", reduced)):
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
            # Volumes of the same kind, grown alike: the peer's pairs are the broad phase's.
            pairs = float(methods["fcl_pairs"]["candidates"])
            self.assertAlmostEqual(pairs / float(reference["candidates"]), 1, delta=0.01)

    def test_an_opencl_device_gives_the_hosts_hash(self):
        rows = self.quick("bench_step", "--backend", "opencl", "--method", "drape", "--method", "drape_kernels", "--method",
                          "drape_reduced")
        for name in ("drape", "drape_kernels", "drape_reduced"):
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
        self.quick("bench_step", "--backend", "host", "--method", "none")
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
        self.assertEqual(run("study", "--part", "no_such_part").returncode, 2)


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


class Reports(ProgramTest):
    """Plots and tables of quick runs; void rows do not reach them."""

    def results(self):
        folder = self.path("results/machine")
        os.makedirs(folder)
        for program in ("bench_step", "study"):
            self.quick(program)
            for ending in ("csv", "json"):
                os.rename(self.path("rows." + ending), f"{folder}/{program}.{ending}")
        return folder

    def test_plots_and_tables(self):
        folder = self.results()
        self.check_summary()
        try:
            import matplotlib  # noqa: F401
        except ModuleNotFoundError:
            self.skipTest("python3-matplotlib is not installed")
        result = self.script("plot.py", folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        pictures = [name for name in os.listdir(folder) if name.endswith(".png")]
        self.assertIn("step_shares.png", pictures)
        self.assertIn("study_construction.png", pictures)

    def check_summary(self):
        """The tables replace what is between the markers, and a second run changes nothing."""
        def marked(*names):
            return "before\n" + "between\n".join(
                f"<!-- {name}: made by summary.py -->\nwhat was there\n<!-- end of {name} -->\n" for name in names) + "after\n"

        paths = self.write_readme(marked("front", "ranking"), "."), self.write_readme(marked("results"))
        result = self.script("summary.py", self.folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertNotIn("does not say its commit", result.stderr)
        texts = []
        for path in paths:
            with open(path) as file:
                texts.append(file.read())
            self.assertTrue(texts[-1].startswith("before\n") and texts[-1].endswith("after\n"))
            self.assertNotIn("what was there", texts[-1])
        self.assertEqual([text.count("between\n") for text in texts], [1, 0])
        front, ranking = texts[0].split("between\n")
        results = texts[1]
        for words in ("## machine", "fcl, 1 thread", "thesis: Quadro", "Whole steps of the host"):
            self.assertIn(words, results)
        for words in ("| machine | host, 1 thread | front |", "The front tests fewer volumes"):
            self.assertIn(words, front)
        for words in ("| refit | over construction", "| construction on the device, largest model, ms | "):
            self.assertIn(words, ranking)
        self.script("summary.py", self.folder)
        for path, text in zip(paths, texts):
            with open(path) as file:
                self.assertEqual(file.read(), text)


class Scripts(ProgramTest):
    """cloth_drop.sh, drop_speeds.sh and drape_check.sh, and the tables of what they write."""

    @staticmethod
    def bash(name, *arguments, **environment):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", name)
        return subprocess.run(["bash", path, *arguments], capture_output=True, text=True, timeout=600,
                              env={**os.environ, "BIN": PROGRAMS, **environment})

    def content(self, name):
        with open(self.path(f"results/machine/{name}.json")) as file:
            content = json.load(file)
        machine = content["machine"]
        self.assertTrue(machine["processor"] and machine["date"])
        self.assertEqual(machine["cores"], os.cpu_count())
        for device in machine["devices"]:
            self.assertTrue(device["device"] and device["driver"], device)
        return content

    def tables(self):
        with open(self.path("results/machine/study.json"), "w") as file:
            json.dump({"machine": {"processor": "p", "cores": 1, "devices": [], "date": "d", "commit": "c"}}, file)
        return self.summary()

    def cloth_drop(self, *options, **environment):
        if not os.path.exists(os.path.join(PROGRAMS, "cloth_drop")):
            self.skipTest("cloth_drop is not built")
        return self.bash("cloth_drop.sh", self.path("results/machine"), *options,
                         **{"BUNNY": "stairs", "STEPS": "20", "COMMIT": "abc1234", **environment})

    def test_the_scene_on_every_back_end(self):
        result = self.cloth_drop("--cloth", "9x9")
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("cloth_drop")
        self.assertEqual(content["scene"], {"obstacle": "stairs", "obstacle_digest": "stairs", "options": ["--cloth", "9x9"]})
        names = [device["device"] for device in content["machine"]["devices"]] + ["host"]
        drape = [row for row in content["rows"] if row["run"] == "drape"]
        self.assertEqual([(row["device"], row["all_contacts"]) for row in drape],
                         [(name, every) for name in names for every in (False, True)])
        self.assertEqual({row["run"] for row in content["rows"]}, {"drape", "bullet_stock", "bullet_tuned"})
        for row in drape:
            self.assertEqual((row["steps"], row["cloth_triangles"], row["nodes_through"]), (20, 128, 0))
            self.assertGreater(row["collision_ms"]["median"], 0)
        text = self.tables()
        for words in ("for 20 steps (`cloth_drop.sh`)", "| Drape, all contacts | host |", "| Bullet built in, tuned | host |",
                      f"`{drape[0]['hash']}`"):
            self.assertIn(words, text)

    def test_the_scene_without_bullet(self):
        self.assertEqual(self.cloth_drop("--no-compare", STEPS="2").returncode, 0)
        self.assertEqual({row["run"] for row in self.content("cloth_drop")["rows"]}, {"drape"})
        self.assertEqual(self.cloth_drop("--no-such-option", STEPS="2").returncode, 1)

    def test_back_ends_that_differ_are_told(self):
        """A program whose hash is its back end's."""
        with open(self.path("cloth_drop"), "w") as file:
            file.write(f"""#!/usr/bin/env bash
[[ $* != *--list-devices* ]] || {{ echo "some device (a platform, driver 1)"; exit; }}
hash=0000000000000001
[[ $* != *"--backend host"* ]] || hash=0000000000000002
"{PROGRAMS}/cloth_drop" --obstacle stairs --cloth 9x9 --steps 2 --backend host --quiet --json - | sed "s/[0-9a-f]\\{{16\\}}/$hash/"
""")
        os.chmod(self.path("cloth_drop"), 0o755)
        result = self.cloth_drop("--no-compare", BIN=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("differ at commit abc1234 after 2 steps", result.stderr)
        self.assertIn("host 0000000000000002", result.stderr)

    def drops(self, **environment):
        if not os.path.exists(os.path.join(PROGRAMS, "cloth_drop")):
            self.skipTest("cloth_drop is not built")
        result = self.bash("drop_speeds.sh", self.path("results/machine"), "--backend", "host", "--cloth", "9x9",
                           BUNNY="stairs", SPEEDS="2 50", COMMIT="abc1234", **environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("drop_speeds")
        self.assertEqual(content["machine"]["commit"], "abc1234")
        self.assertEqual([(row["speed_m_s"], row["run"]) for row in content["rows"]],
                         [(speed, run) for speed in (2, 50)
                          for run in ("automatic", "continuous", "discrete", "stock", "tuned")])
        return content["rows"]

    def test_drops_at_every_speed(self):
        for row in self.drops(STEPS="3"):
            self.assertEqual((row["ended"], row["steps"]), ("whole", 3), row)
            self.assertLessEqual(row["nodes_below_surface"], row["nodes_below_surface_max"])
            if row["run"] in ("automatic", "continuous"):
                self.assertEqual((row["nodes_below_surface_max"], row["nodes_through"]), (0, 0), row)
            elif row["run"] == "stock" and row["speed_m_s"] == 50:
                self.assertGreater(row["nodes_through"], 0, "a child's")
            elif row["run"] == "discrete" and row["speed_m_s"] == 50:
                self.assertGreater(row["nodes_below_surface_max"], row["nodes_below_surface"], "not the last step alone")
                self.assertGreater(row["nodes_through"], row["nodes_below_surface_max"])
                through = f"/ {row['nodes_below_surface_max']} / {row['nodes_through']} /"
        text = self.tables()
        self.assertIn("|  | 2 m/s | 50 m/s |", text)
        self.assertIn(through, text)
        self.assertIn("at abc1234.", text)
        self.assertNotIn("of 3 steps", text)

    def test_drops_that_reach_their_limit_keep_their_steps(self):
        for row in self.drops(STEPS="40", LIMIT="1e-9"):
            self.assertEqual(row["ended"], "by the time limit", row)
            built_in = row["run"] in ("stock", "tuned")
            self.assertEqual(row["steps"], 0 if built_in else 1, "Bullet's step in hand is given up")
            if row["run"] == "automatic":
                self.assertEqual(row["intersecting_pairs_max"], 0)
        self.assertIn("1 of 40 steps", self.tables())

    def truth(self):
        """Records with a hit each and, of the triangles, an answer that is wrong; a mesh that passes itself."""
        folder = self.path("truth")
        os.makedirs(folder)
        face = [0, 0, 0, 4, 0, 0, 0, 4, 0]
        motion = struct.pack("<24f2i", 1, 1, 1, *face, 1, 1, -1, *face, 0, 1)
        through = struct.pack("<18fi", *face, 0, 0, -1, 1, 0, 0, 0, 1, 0, 1)
        above = struct.pack("<18fi", *face, 0, 0, 1, 1, 0, 2, 0, 1, 2, 1)
        for name, records in (("ccd_queries.bin", motion), ("triangle_pairs.bin", through + above)):
            with open(os.path.join(folder, name), "wb") as file:
                file.write(records)
        for name, height in (("cloth_ball92.ply", 1), ("cloth_ball93.ply", -1)):
            with open(os.path.join(folder, name), "w") as file:
                file.write("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                           f"0 0 0\n4 0 0\n0 4 0\n0.5 0.5 {height}\n1 0.5 {height}\n0.5 1 {height}\n3 0 1 2\n3 3 4 5\n")
        return folder

    def test_published_queries_on_every_back_end(self):
        result = self.bash("drape_check.sh", self.path("results/machine"), "--truth", self.truth(), "--commit", "abc1234")
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("drape_check")
        names = ["host"] + [device["device"] for device in content["machine"]["devices"]]
        self.assertEqual([row["device"] for row in content["ccd"]], names)
        self.assertEqual([(row["mode"], row["device"]) for row in content["triangles"]],
                         [(mode, name) for mode in ("fast", "exact", "moller") for name in names])
        self.assertEqual({(row["misses"], row["false_hits"]) for row in content["ccd"]}, {(0, 0)})
        self.assertEqual({(row["misses"], row["false_hits"]) for row in content["triangles"]}, {(1, 0)})
        self.assertEqual([(row["mode"], row["device"], row["intersecting_pairs"]) for row in content["pairs"]],
                         [(mode, name, count) for mode, count in (("frame 92", 0), ("frame 93", 0), ("92 and 93", 1))
                          for name in names])
        self.assertEqual({(row["device"], row["vf_hits"]) for row in content["step"]}, {(name, 3) for name in names})
        text = self.tables()
        self.assertIn("| triangles exact | host | 2 | 1 | 0 |", text)
        self.assertIn("| ccd | host | 1 | 0 | 0 |", text)
        self.assertRegex(text, r"\| 92 and 93 \| host \| \d+ \| 1 \|")
        self.assertIn("at abc1234.", text)

    def test_queries_that_are_not_there_are_named(self):
        folder = self.truth()
        os.remove(os.path.join(folder, "ccd_queries.bin"))
        result = self.bash("drape_check.sh", self.path("results/machine"), "--truth", folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("ccd_queries.bin", result.stderr)
        content = self.content("drape_check")
        self.assertNotIn("ccd", content)
        self.assertTrue(content["triangles"])
        self.assertEqual(self.bash("drape_check.sh", self.path("results/machine")).returncode, 2)


class Hashes(ProgramTest):
    """Trajectories of several results."""

    def write(self, folder, name, commit, device, hash, scene="d", options=(), **columns):
        os.makedirs(self.path("results/" + folder), exist_ok=True)
        row = {"run": "drape", "all_contacts": False, "device": device, "steps": 240, "hash": hash, "step_ms": {},
               "collision_ms": {"median": 1, "p95": 2}, "penetration_max_m": 0, "intersecting_pairs_end": 0,
               "nodes_below_surface": 0, "nodes_through": 0, "intersecting_pairs_max": 0, "contacts_max": 1, "ended": "whole",
               "speed_m_s": 0, **columns}
        with open(self.path(f"results/{folder}/{name}.json"), "w") as file:
            json.dump({"machine": {"commit": commit, "date": "d"}, "steps": 240, "rows": [row],
                       "scene": {"obstacle": "o", "obstacle_digest": scene, "options": list(options)}}, file)

    def judged(self):
        readme = self.write_readme("<!-- results: made by summary.py -->as it was<!-- end of results -->")
        result = self.script("summary.py", self.folder)
        with open(readme) as file:
            self.assertEqual("as it was" in file.read(), result.returncode != 0, "no table of results that are refused")
        return result

    def refused(self, *words):
        result = self.judged()
        self.assertEqual(result.returncode, 1)
        for word in words:
            self.assertIn(word, result.stderr)

    def accepted(self):
        result = self.judged()
        self.assertEqual(result.returncode, 0, result.stderr)
        return result

    def test_one_run_on_two_machines(self):
        self.write("a", "cloth_drop", "abc1234", "gpu", "1")
        self.write("b", "cloth_drop", "abc1234", "cpu", "1")
        self.accepted()
        self.write("b", "cloth_drop", "abc12345", "cpu", "2")
        self.refused("a/cloth_drop.json: automatic on gpu 1", "b/cloth_drop.json: automatic on cpu 2")

    def test_one_run_in_two_files(self):
        self.write("a", "cloth_drop", "abc1234", "gpu", "1")
        self.write("a", "drop_speeds", "abc1234", "gpu", "2", run="automatic", options=["--device", "gpu"])
        self.refused("a/cloth_drop.json", "a/drop_speeds.json")

    def test_other_runs_may_differ(self):
        for other in ({"commit": "abc1235"}, {"scene": "e"}, {"options": ["--cloth", "9x9"]}, {"all_contacts": True},
                      {"steps": 52}, {"run": "bullet_stock"}, {"speed_m_s": 2}, {"commit": "abc1234-dirty"}):
            with self.subTest(**other):
                self.write("a", "cloth_drop", "abc1234", "gpu", "1")
                self.write("b", "cloth_drop", **{"commit": "abc1234", "device": "cpu", "hash": "2", **other})
                self.accepted()

    def test_results_that_cannot_be_compared_are_named(self):
        self.write("a", "cloth_drop", "unknown", "gpu", "1")
        self.assertIn("a/cloth_drop.json does not say its commit", self.accepted().stderr)


class Growth(ProgramTest):
    """Which stages grow faster than n log n, from times that are known."""

    SIZES = (512, 8192, 131072, 2097152)

    def summary_of(self, **stages):
        """The summary of a machine whose stages took stages[name](n) ms on the sweep on_1k."""
        folder = self.path("results/machine")
        os.makedirs(folder, exist_ok=True)
        columns = ["scene", "sweep", "method", "stage", "cloth_triangles", "obstacle_triangles", "median_ms", "candidates"]
        with open(f"{folder}/bench_step.csv", "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(columns)
            for size in self.SIZES:
                for stage, time in stages.items():
                    writer.writerow([f"s{size}", "on_1k", "drape_host", stage, size, 1280, time(size), 3 * size])
        with open(f"{folder}/bench_step.json", "w") as file:
            json.dump({"machine": {"processor": "p", "cores": 1, "devices": [], "date": "d", "commit": "c"}}, file)
        return self.summary()

    def test_linear_and_n_log_n_are_within(self):
        text = self.summary_of(broad=lambda n: 0.999e-5 * n * math.log(n), narrow=lambda n: 1e-5 * n)
        self.assertIn("No stage of Drape grows faster than n log n", text)
        self.assertIn("| narrow | 1.00 | 1.10 |", text)

    def test_a_stage_that_grows_faster_is_named(self):
        text = self.summary_of(broad=lambda n: 1e-5 * n, narrow=lambda n: 1e-6 * n ** 1.2)
        self.assertNotIn("No stage of Drape", text)
        self.assertIn("faster than n log n: Drape, host, narrow (cloth triangles, on a sphere of 1,280: 1.20", text)
        self.assertIn("**1.20**", text)


if __name__ == "__main__":
    unittest.main()
