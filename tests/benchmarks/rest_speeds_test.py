"""rest_speeds runs, gives equal runs equal hashes, and fails above its limit.

Usage: rest_speeds_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest, run


class RestSpeeds(ProgramTest):
    def test_cloth_settles(self):
        rows = self.quick("rest_speeds", "--scene", "stairs", "--fall", "1", "--settle", "60", "--steps", "30")
        again = self.quick("rest_speeds", "--scene", "stairs", "--fall", "1", "--settle", "60", "--steps", "30")
        self.assertEqual([row["scene"] for row in rows], ["stairs"])
        self.assertEqual(rows[0]["hash"], again[0]["hash"])
        self.assertEqual(rows[0]["intersecting"], "0")
        self.assertGreater(float(rows[0]["speed_mm_s"]), 0)

    def test_motion_above_the_limit_is_a_failure(self):
        result = run("rest_speeds", "--quick", "--scene", "stairs", "--fall", "1", "--settle", "0", "--steps", "5",
                     "--most", "0.1")
        self.assertNotEqual(result.returncode, 0)

    def test_unknown_scenes_are_refused(self):
        self.refused("rest_speeds", ["--scene", "stair"], "did you mean stairs?")


if __name__ == "__main__":
    unittest.main()
