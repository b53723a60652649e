"""error_vs_time runs, its table parses, what may change time only changes nothing else, answers that must be right are,
stalled runs are capped, the plots and summary appear, and results that were measured run by run become one.

Usage: error_vs_time_test.py PROGRAM
"""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", "error_vs_time")
sys.path.insert(0, SCRIPTS)
sys.path.insert(0, os.path.dirname(SCRIPTS))
import error_summary
from results import read_rows


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_script(self, *command):
        return subprocess.run([*command], capture_output=True, text=True, timeout=280)


class ErrorVsTimeTest(FolderTest):
    def rows(self, *arguments, code=0, quick=True):
        path = self.path("error_vs_time")
        result = self.run_script(PROGRAM, *["--quick"] * quick, "--csv", path + ".csv", "--json", path + ".json", *arguments)
        self.assertEqual(result.returncode, code, result.stderr)
        with open(path + ".json") as file:
            self.assertIn("machine", json.load(file))
        with open(path + ".csv", newline="") as file:
            return list(csv.DictReader(file, strict=True))

    def check_simulations(self, rows):
        self.assertEqual({row["scene"] for row in rows}, {"stairs", "plate"})
        for row in rows:
            self.assertEqual(row["ended"], "whole", row)
            self.assertGreater(float(row["frame_median_ms"]), 0)
            self.assertEqual(int(float(row["invalid_nodes"])), 0)
            if row["method"] != "bullet" and row["setting"] != "discrete":
                self.assertGreater(int(float(row["contacts_max"])), 0)
                self.assertEqual(float(row["penetration_max"]), 0, row)
                self.assertEqual(float(row["nodes_through"]), 0, row)
            if row["knob"] in ("fall", "rest"):
                self.assertFalse(row["shape_error"])
            else:
                self.assertGreaterEqual(float(row["shape_error"]), 0)
            self.assertEqual(row["must_match"] == "defaults", row["valid"] == "yes")
            if row["knob"] == "reference":
                self.assertEqual(float(row["shape_error"]), 0)
            # An obstacle that moves brings energy in.
            self.assertEqual(row["energy_gain"] != "", row["scene"] == "stairs")
            if row["energy_gain"]:
                self.assertLessEqual(float(row["energy_gain"]), float(row["energy_rise"]))
        # At 30 m/s neither the built-in collision nor the discrete mode sees the plate.
        for wanted in ({"method": "bullet"}, {"setting": "discrete"}):
            through = [row for row in rows if row["scene"] == "plate" and wanted.items() <= row.items()]
            self.assertGreater(float(through[0]["nodes_through"]), 50)
        same = [row for row in rows if row["method"] != "bullet" and
                (row["knob"] in ("defaults", "traversal") or row["setting"] == "continuous")]
        self.assertGreaterEqual(len(same), 8)
        self.assertTrue(all(row["valid"] == "yes" for row in same), same)
        for scene in ("stairs", "plate"):
            self.assertEqual(len({row["hash"] for row in same if row["scene"] == scene}), 1)

        self.check_contacts(rows)

    def check_contacts(self, rows):
        drape = [row for row in rows if row["method"] == ("drape" if any(row["method"] == "drape" for row in rows) else "drape_host")]
        most = {(row["scene"], row["knob"], row["setting"]): int(row["contacts_max"]) for row in drape if row["value"] == "0"}
        # Contacts are left out on the stairs, which rest, and the course differs; beside what moves none are.
        self.assertGreater(most["stairs", "contacts", "all"], most["stairs", "defaults", ""])
        self.assertEqual(most["plate", "contacts", "all"], most["plate", "defaults", ""])
        rests = [row for row in rows if row["knob"] == "rest"]
        self.assertEqual({(row["scene"], row["value"], row["seed"], row["setting"]) for row in rests},
                         {("stairs", "0", "0", ""), ("stairs", "0", "0", "all"), ("stairs", "1", "1", "")})
        self.assertEqual(len({row["hash"] for row in rests}), 3)
        for row in rests:
            self.assertEqual((row["speed_frames"], row["frames"]), ("50", "80"))
            self.assertGreater(float(row["rest_speed_mm_s"]), 0)

    def check_detector(self, rows):
        for row in rows:
            self.assertGreater(float(row["query_median_us"]), 0)
            if row["setting"] not in ("float",):
                self.assertEqual(int(float(row["misses"])), 0, row)
            if row["setting"] in ("exact", "double"):
                self.assertEqual(int(float(row["false_hits"])), 0, row)
            if row["late_times"]:
                self.assertEqual(int(float(row["late_times"])), 0, row)
            if row["distance_error_max"] and row["method"] == "drape_host":
                self.assertLess(float(row["distance_error_max"]), 1e-6)
        # What is beside Drape is wrong where it must be, so that the sets can tell.
        wrong = {row["scene"]: int(float(row["misses"])) for row in rows if row["setting"] == "float"}
        self.assertGreater(wrong["pairs at 10 km"], 0)
        # A finer search of the time gives a better time.
        times = {row["value"]: float(row["time_error_p50"]) for row in rows
                 if row["scene"] == "motions at 1 m" and row["method"] == "drape_host" and row["knob"] == "time tolerance"}
        self.assertLess(times["1e-06"], times["0.001"])
        self.assertLess(times["0.001"], times["0.1"])

    def test_rows_plots_and_summary(self):
        rows = self.rows()
        self.check_simulations([row for row in rows if row["part"] == "simulation"])
        self.check_detector([row for row in rows if row["part"] == "detector"])

        folders = [self.path(f"results/{name}") for name in ("two", "one")]
        for folder in folders:
            os.makedirs(folder)
            for ending in (".csv", ".json"):
                shutil.copy(self.path("error_vs_time" + ending), folder)
        readme = self.path("results/README.md")
        with open(readme, "w") as file:
            file.write("Before.\n")
        for folder in folders:  # the second time it replaces
            subprocess.run([sys.executable, os.path.join(SCRIPTS, "plot.py"), folder, readme], check=True)
        with open(readme) as file:
            text = file.read()
        self.assertTrue(text.startswith("Before.\n"))
        self.assertEqual([line for line in text.splitlines() if line.startswith("##")],
                         ["## Error against run time: one", "## Error against run time: two"])
        for folder in folders:
            for name in ("penetration", "pairs", "through", "detector_false_hits", "detector_time"):
                self.assertGreater(os.path.getsize(os.path.join(folder, f"error_{name}.png")), 10000)

    def test_speed_at_rest_is_taken_over_more_frames_of_the_same_course(self):
        rows = self.rows("--scene", "stairs", "--knob", "rest", "--backend", "host", "--frames", "80")
        usual, rest = ([row for row in rows if row["knob"] == knob and row["method"] == "drape_host"][0]
                       for knob in ("defaults", "rest"))
        self.assertEqual((usual["hash"], usual["speed_frames"], rest["speed_frames"]), (rest["hash"], "8", "50"))
        # The cloth settles: earlier frames were faster.
        self.assertGreater(float(rest["rest_speed_mm_s"]), 1.2 * float(usual["late_speed_mm_s"]))

    def test_capped_runs_have_no_errors_to_show(self):
        rows = self.rows("--part", "simulation", "--scene", "stairs", "--knob", "defaults", "--backend", "host", "--cap",
                         "0.000001", "--frames", "2000")
        self.assertTrue(rows)
        for row in rows:
            self.assertEqual(row["ended"], "capped")
            self.assertFalse(row.get("penetration_max"))

    def test_runs_of_the_built_in_are_left_out_where_it_stalls(self):
        rows = self.rows("--part", "simulation", "--scene", "stairs", "--knob", "voxel", "--backend", "host", "--cap",
                         "0.000001", "--frames", "2000", quick=False)
        self.assertEqual([row["ended"] for row in rows if row["method"] == "bullet"],
                         ["capped", "capped", "capped", "left out"])

    def test_what_does_not_fit_into_the_time_is_named(self):
        rows = self.rows("--part", "simulation", "--backend", "host", "--minutes", "0.0001", code=1)
        self.assertTrue(rows)
        self.assertEqual({row["ended"] for row in rows}, {"no time"})

    def test_a_run_that_outlasts_the_time_did_not_stall(self):
        # The cap is far off: what ends the steps is the whole program's time.
        rows = self.rows("--scene", "stairs", "--knob", "defaults", "--backend", "host", "--frames", "1000000",
                         "--minutes", "0.05", code=1)
        self.assertTrue(rows)
        for row in rows:
            self.assertEqual(row["ended"], "no time")
            self.assertFalse(row.get("frame_median_ms"))

    def test_what_does_not_exist_is_refused(self):
        for arguments, words in ((["--scene", "moon"], ("moon", "bunny")), (["--knob", "nosuch"], ("nosuch", "substeps")),
                                 (["--truth", self.path("none")], ("--truth", "none"))):
            result = self.run_script(PROGRAM, "--quick", "--scene", "stairs", *arguments)
            self.assertEqual((result.returncode, result.stdout, result.stderr.count("\n")), (2, "", 1), result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)

    def measure(self, *arguments):
        return self.run_script("bash", os.path.join(SCRIPTS, "run.sh"), "--bin", os.path.dirname(PROGRAM), "--quick", "--commit", "c",
                               "--backend", "host", *arguments, self.path("out"))

    def test_knobs_measured_run_by_run_become_one(self):
        for knob in ("substeps", "mode"):
            result = self.measure("--scene", "stairs", "--knob", knob)
            self.assertEqual(result.returncode, 0, result.stderr)
        rows = read_rows(self.path("out"), "error_vs_time")
        self.assertEqual({row["part"] for row in rows}, {"simulation"})
        self.assertEqual([row["knob"] for row in rows], ["defaults", "defaults", "reference", "substeps", "mode", "mode"])
        self.assertEqual({row["commit"] for row in rows}, {"c, quick"})
        # Without time nothing is lost.
        result = self.measure("--scene", "stairs", "--minutes", "0.0001")
        self.assertEqual(result.returncode, 1, result.stderr)
        kept = [row for row in read_rows(self.path("out"), "error_vs_time") if row["ended"] == "whole"]
        self.assertEqual([row["hash"] for row in kept], [row["hash"] for row in rows])


class Merge(FolderTest):
    def row(self, **cells):
        return {"part": "simulation", "scene": "stairs", "method": "drape_host", "knob": "defaults", "value": 0.0, "setting": "",
                "ended": "whole", "frame_median_ms": 1.0, "hash": "h", "must_match": "defaults", "valid": "yes", **cells}

    def merge(self, rows, **machine):
        content = {"machine": {"date": "2026-01-01", "commit": "a", "processor": "p", "cores": 2, "devices": [], **machine},
                   "rows": rows}
        with open(self.path("new.json"), "w") as file:
            json.dump(content, file)
        result = self.run_script(sys.executable, os.path.join(SCRIPTS, "merge_errors.py"), self.path("out"), self.path("new.json"))
        return result.returncode, result.stderr

    def merged(self):
        with open(self.path("out/error_vs_time.json")) as file:
            return json.load(file)["rows"]

    def test_rows_join_and_those_measured_anew_replace(self):
        substeps = self.row(knob="substeps", value=2.0, must_match="", hash="s")
        pile = self.row(scene="pile")
        query = self.row(part="detector", scene="motions", must_match="same")
        for rows in ([pile, self.row(), substeps], [query], [{**substeps, "value": 4.0}, {**substeps, "frame_median_ms": 2.0}]):
            self.assertEqual(self.merge(rows), (0, ""))
        self.assertEqual(self.merge([self.row()], commit="b"), (0, ""))
        a = {"commit": "a"}
        self.assertEqual(self.merged(), [{**query, **a}, {**self.row(), "commit": "b"}, {**substeps, **a, "frame_median_ms": 2.0},
                                         {**substeps, **a, "value": 4.0}, {**pile, **a}])
        self.assertEqual([(row["commit"], row["value"]) for row in read_rows(self.path("out"), "error_vs_time")],
                         [("a", 0), ("b", 0), ("a", 2), ("a", 4), ("a", 0)])

    def test_what_was_not_run_replaces_only_what_says_less(self):
        order = ("no time", "left out", "whole")
        for before in order:
            for after in order:
                for commit in "ab":
                    self.merge([self.row(ended=before)])
                    self.merge([self.row(ended=after)], commit=commit)
                    kept = before if order.index(after) < order.index(before) else after
                    self.assertEqual(self.merged()[0]["ended"], kept, (before, after, commit))
                    os.remove(self.path("out/error_vs_time.json"))

    def test_another_machine_is_refused(self):
        self.merge([self.row()])
        code, said = self.merge([self.row(hash="other")], processor="q")
        self.assertEqual(code, 2)
        self.assertIn("another machine", said)
        self.assertEqual([row["hash"] for row in self.merged()], ["h"])

    def test_a_row_without_a_name_is_refused(self):
        row = self.row()
        del row["setting"]
        self.assertEqual(self.merge([row])[0], 2)

    def test_rows_of_one_commit_are_judged_together(self):
        device = self.row(method="drape", valid="", hash="x")
        self.assertEqual(self.merge([device, self.row(method="drape", knob="substeps", value=2.0, must_match="", hash="y")])[0], 0)
        self.assertEqual(self.merge([self.row()], commit="b")[0], 0)  # of another commit: says nothing
        self.assertEqual(self.merge([self.row(commit="a")])[0], 3)
        rows = {row["hash"]: row for row in self.merged()}
        self.assertEqual((rows["x"]["valid"], rows["h"]["valid"], rows["y"]["valid"]), ("no", "yes", "yes"))
        self.assertNotIn("frame_median_ms", rows["x"])
        self.assertIn("frame_median_ms", rows["y"])
        self.assertEqual({row["hash"] for row in read_rows(self.path("out"), "error_vs_time")}, {"h", "y"})
        # A void row is void until it is measured anew.
        self.assertEqual(self.merge([self.row(scene="pile")])[0], 3)
        self.assertEqual(self.merge([{**device, "hash": "h"}])[0], 0)

    def test_queries_are_judged_by_the_same_query_on_the_host(self):
        query = self.row(part="detector", scene="motions", must_match="same", knob="tolerance", value=1e-3)
        self.assertEqual(self.merge([{**query, "method": "drape"}, self.row(part="detector", scene="motions", hash="other")])[0], 0)
        self.assertEqual(self.merge([query])[0], 0)
        self.assertEqual(self.merge([{**query, "hash": "g"}])[0], 3)
        self.assertEqual({row["method"]: row["valid"] for row in self.merged() if row["knob"] == "tolerance"},
                         {"drape": "no", "drape_host": "yes"})


class Summary(unittest.TestCase):
    def lines(self, text):
        return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("|")][2:]

    def fall(self, scene, seed, **wrong):
        return {"part": "simulation", "scene": scene, "method": "drape", "knob": "fall", "value": seed, "ended": "whole", **wrong}

    def test_falls_are_told_scene_by_scene(self):
        rows = [self.fall("stairs", seed) for seed in range(8)] + [self.fall("plate", 1), self.fall("plate", 2, intersecting_max=3),
                                                                   self.fall("pile", 1, ended="no time")]
        self.assertEqual(self.lines(error_summary.falls_text(rows)),
                         [["stairs", "Drape, device", "8", "8", "37.5 %"], ["plate", "Drape, device", "2", "1", "–"]])
        self.assertEqual(error_summary.falls_text([]), "")

    def test_pairs_are_the_most_after_any_step(self):
        row = {**self.fall("stairs", 0), "knob": "defaults", "intersecting_max": 12.0, "intersecting_end": 5.0}
        self.assertIn("12", self.lines(error_summary.scenes_table([row]))[0])
        self.assertNotIn("5", self.lines(error_summary.scenes_table([row]))[0])

    def test_times_of_impact_say_their_worst(self):
        row = {"scene": "motions", "method": "drape", "knob": "defaults", "query_median_us": 1, "misses": 0, "true_pairs": 5,
               "false_hits": 0, "queries": 9, "time_error_p50": 0.001, "time_error_max": 0.25, "late_times": 1200}
        self.assertEqual(self.lines(error_summary.detector_table([row]))[0][6:9], ["0.001", "0.25", "1,200"])


if __name__ == "__main__":
    unittest.main()
