"""error_vs_time runs, its table parses, what may change time only changes nothing else, answers that must be right are,
and stalled runs are capped.

Usage: error_vs_time_test.py FOLDER_OF_PROGRAMS
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.join(os.path.abspath(sys.argv.pop(1)), "error_vs_time")


class ErrorVsTimeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_script(self, *command):
        return subprocess.run([*command], capture_output=True, text=True, timeout=280)

    def rows(self, *arguments, code=0, quick=True):
        path = self.path("error_vs_time")
        result = self.run_script(PROGRAM, *["--quick"] * quick, "--csv", path + ".csv", "--json", path + ".json",
                                 *arguments)
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
        # At 30 m/s neither Bullet's own collision nor the discrete mode sees the plate.
        for wanted in ({"method": "bullet"}, {"setting": "discrete"}):
            through = [row for row in rows if row["scene"] == "plate" and wanted.items() <= row.items()]
            self.assertGreater(float(through[0]["nodes_through"]), 50)
        same = [row for row in rows if row["method"] != "bullet" and
                (row["knob"] == "defaults" or row["setting"] == "continuous")]
        self.assertGreaterEqual(len(same), 6)
        self.assertTrue(all(row["valid"] == "yes" for row in same), same)
        for scene in ("stairs", "plate"):
            self.assertEqual(len({row["hash"] for row in same if row["scene"] == scene}), 1)

        self.check_rest(rows)

    def check_rest(self, rows):
        rests = [row for row in rows if row["knob"] == "rest"]
        self.assertEqual({(row["scene"], row["value"], row["seed"], row["setting"]) for row in rests},
                         {("stairs", "0", "0", ""), ("stairs", "1", "1", "")})
        self.assertEqual(len({row["hash"] for row in rests}), 2)
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
        # The other methods must be wrong in places, or the sets would distinguish nothing.
        wrong = {row["scene"]: int(float(row["misses"])) for row in rows if row["setting"] == "float"}
        self.assertGreater(wrong["pairs at 10 km"], 0)
        # A finer search of the time gives a better time.
        times = {row["value"]: float(row["time_error_p50"]) for row in rows
                 if row["scene"] == "motions at 1 m" and row["method"] == "drape_host"
                 and row["knob"] == "time tolerance"}
        self.assertLess(times["1e-06"], times["0.001"])
        self.assertLess(times["0.001"], times["0.1"])

    def test_rows_of_every_part(self):
        rows = self.rows()
        self.check_simulations([row for row in rows if row["part"] == "simulation"])
        self.check_detector([row for row in rows if row["part"] == "detector"])

    def test_speed_at_rest_is_taken_over_more_frames_of_the_same_course(self):
        rows = self.rows("--scene", "stairs", "--knob", "rest", "--backend", "host", "--frames", "80")
        usual, rest = ([row for row in rows if row["knob"] == knob and row["method"] == "drape_host"][0]
                       for knob in ("defaults", "rest"))
        self.assertEqual((usual["hash"], usual["speed_frames"], rest["speed_frames"]), (rest["hash"], "8", "50"))
        # The cloth settles: earlier frames were faster.
        self.assertGreater(float(rest["rest_speed_mm_s"]), 1.2 * float(usual["late_speed_mm_s"]))

    def test_capped_runs_have_no_errors_to_show(self):
        rows = self.rows("--part", "simulation", "--scene", "stairs", "--knob", "defaults", "--backend", "host",
                         "--cap",
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

    def test_a_child_that_finds_no_device_runs_no_other_trial(self):
        # Trial 1 of the parent with a device is Drape on it. Without the device the child must refuse it.
        environment = {**os.environ, "OCL_ICD_VENDORS": "/nonexistent"}
        command = [PROGRAM, "--quick", "--backend", "opencl", "--child-scene", "stairs", "--child-trial", "1",
                   "--child-device"]
        result = subprocess.run(command, capture_output=True, text=True, timeout=100, env=environment)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("OpenCL", result.stderr)

    def test_what_does_not_exist_is_refused(self):
        for arguments, words in ((["--scene", "moon"], ("moon", "bunny")),
                                 (["--knob", "nosuch"], ("nosuch", "substeps")),
                                 (["--truth", self.path("none")], ("--truth", "none"))):
            result = self.run_script(PROGRAM, "--quick", "--scene", "stairs", *arguments)
            self.assertEqual((result.returncode, result.stdout, result.stderr.count("\n")), (2, "", 1), result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
