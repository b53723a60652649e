"""cloth_scenes runs, gives equal runs equal hashes, and finds no pair that intersects.

Usage: cloth_scenes_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest


class ClothScenes(ProgramTest):
    def test_sheets_fall_on_a_sphere(self):
        options = ["--scene", "sheets_on_sphere", "--length", "0.5"]
        rows = self.quick("cloth_scenes", *options)
        again = self.quick("cloth_scenes", *options, "--threads", "1")
        self.assertEqual([row["scene"] for row in rows], ["sheets_on_sphere"])
        self.assertEqual(rows[0]["hash"], again[0]["hash"])
        self.assertEqual(rows[0]["self_pairs_max"], "0")
        self.assertEqual(rows[0]["obstacle_pairs_max"], "0")
        self.assertGreater(int(rows[0]["self_contacts_max"]), 0)

    def test_unknown_scenes_are_refused(self):
        self.refused("cloth_scenes", ["--scene", "twists"], "did you mean twist?")


if __name__ == "__main__":
    unittest.main()
