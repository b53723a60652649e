"""plugin_start's world computes the same on the host, on a device, and where it moves from one to the other.

Usage: plugin_start_test.py FOLDER_OF_PROGRAMS
"""
import csv
import io
import os
import unittest

from programs import ProgramTest, run


class PluginStart(ProgramTest):
    def start(self, *options):
        result = run("plugin_start", "--csv", "-", *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return next(csv.DictReader(io.StringIO(result.stdout)))

    def test_the_world_moves_and_keeps_its_bits(self):
        moved = self.start("--backend", "cost", "--crossover", "0")
        host = self.start("--backend", "host", "--steps", moved["steps"])
        self.assertEqual(moved["hash"], host["hash"])
        self.assertEqual(host["steps_on_host"], host["steps"])
        if os.environ.get("DRAPE_TEST_NO_DEVICE") != "1":
            self.assertLess(int(moved["steps_on_host"]), int(moved["steps"]))

    def test_a_named_device_is_there_at_once(self):
        if os.environ.get("DRAPE_TEST_NO_DEVICE") == "1":
            self.skipTest("no OpenCL device")
        row = self.start("--backend", "opencl")
        self.assertNotEqual(row["device"], "host")
        self.assertGreater(float(row["build_ms"]), 0)


if __name__ == "__main__":
    unittest.main()
