"""What summary.py and plot.py make of results: tables, pictures and what they refuse or name.

Usage: reports_test.py FOLDER_OF_PROGRAMS
"""
import csv
import json
import math
import os
import unittest

from programs import ProgramTest


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
