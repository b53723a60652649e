"""idle_cost measures each method in each scene, and its limits fail where they are passed.

Usage: idle_cost_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest

METHODS = ["stock", "drape_bullet_links", "drape"]


class IdleCost(ProgramTest):
    def test_each_method_is_measured_beside_stock_bullet(self):
        rows = self.quick("idle_cost", "--steps", "40")
        self.assertEqual([row["method"] for row in rows], METHODS * 4)
        for row in rows:
            self.assertGreater(float(row["step_us"]), 0)
            self.assertGreater(float(row["first_step_us"]), 0)
            if row["method"] == "stock":
                self.assertEqual(float(row["extra_us"]), 0)
                self.assertEqual(float(row["constructor_mib"]), 0)

    def test_unknown_scenes_are_refused(self):
        self.refused("idle_cost", ["--scene", "fall_34"], "did you mean fall_33?")


if __name__ == "__main__":
    unittest.main()
