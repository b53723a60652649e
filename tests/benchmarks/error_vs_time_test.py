"""error_vs_time runs, its table parses, device and host agree, stalled runs are capped, and the plots and summary appear.

Usage: error_vs_time_test.py PROGRAM
"""
import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM = os.path.abspath(sys.argv.pop(1))
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", "error_vs_time")


class ErrorVsTimeTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def rows(self, *arguments, code=0):
        path = os.path.join(self.folder, "error_vs_time")
        result = subprocess.run([PROGRAM, "--quick", "--csv", path + ".csv", "--json", path + ".json", *arguments],
                                capture_output=True, text=True, timeout=280)
        self.assertEqual(result.returncode, code, result.stderr)
        with open(path + ".json") as file:
            self.assertIn("machine", json.load(file))
        with open(path + ".csv", newline="") as file:
            return list(csv.DictReader(file, strict=True))

    def test_rows_plots_and_summary(self):
        rows = self.rows()
        self.assertEqual({row["scene"] for row in rows}, {"stairs", "plate"})
        for row in rows:
            self.assertEqual(row["ended"], "whole", row)
            self.assertGreater(float(row["frame_median_ms"]), 0)
            self.assertEqual(int(float(row["invalid_nodes"])), 0)
            if row["method"] != "bullet":
                self.assertGreater(int(float(row["contacts_max"])), 0)
                self.assertEqual(float(row["penetration_max"]), 0, row)
                self.assertEqual(float(row["nodes_through"]), 0, row)
            self.assertGreaterEqual(float(row["shape_error"]), 0)
            if row["knob"] == "reference":
                self.assertEqual(float(row["shape_error"]), 0)
        # At 30 m/s the built-in collision does not see the plate.
        through = [row for row in rows if row["scene"] == "plate" and row["method"] == "bullet"]
        self.assertGreater(float(through[0]["nodes_through"]), 50)
        checked = [row for row in rows if row["method"] in ("drape", "drape_host") and row["knob"] == "defaults"]
        self.assertTrue(all(row["valid"] == "yes" for row in checked))

        readme = os.path.join(self.folder, "README.md")
        with open(readme, "w") as file:
            file.write("Before.\n")
        for _ in range(2):  # the second time it replaces
            subprocess.run([sys.executable, os.path.join(SCRIPTS, "plot.py"), self.folder, readme], check=True)
        with open(readme) as file:
            text = file.read()
        self.assertTrue(text.startswith("Before.\n"))
        self.assertEqual(text.count("### Error against run time"), 1)
        self.assertGreater(os.path.getsize(os.path.join(self.folder, "error_penetration.png")), 10000)

    def test_capped_runs_have_no_errors_to_show(self):
        rows = self.rows("--scene", "stairs", "--knob", "defaults", "--backend", "host", "--cap", "0.000001")
        self.assertTrue(rows)
        for row in rows:
            self.assertEqual(row["ended"], "capped")
            self.assertFalse(row.get("penetration_max"))

    def test_what_does_not_exist_is_refused(self):
        result = subprocess.run([PROGRAM, "--scene", "moon"], capture_output=True, text=True, timeout=60)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("moon", result.stderr)


if __name__ == "__main__":
    unittest.main()
