"""many_cloths runs, and host and device move the cloths alike.

Usage: many_cloths_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest


class ManyCloths(ProgramTest):
    def test_host_and_device_move_cloths_alike(self):
        rows = {row["method"]: row for row in self.quick("many_cloths", "--nodes", "9", "--steps", "60")}
        self.assertEqual(set(rows), {"host", "device", "kept", "auto", "bullet_links"})
        self.assertEqual(rows["host"]["hash"], rows["device"]["hash"])
        self.assertEqual(rows["host"]["hash"], rows["kept"]["hash"])
        self.assertEqual(rows["host"]["hash"], rows["auto"]["hash"])
        self.assertNotEqual(rows["host"]["hash"], rows["bullet_links"]["hash"])
        self.assertEqual(rows["host"]["cloths_on_device"], "0")
        self.assertGreater(float(rows["host"]["median_ms"]), 0)

    def test_unknown_methods_are_refused(self):
        self.refused("many_cloths", ["--method", "hosts"], "did you mean host?")


if __name__ == "__main__":
    unittest.main()
