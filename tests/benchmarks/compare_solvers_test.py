"""compare_solvers runs, and Drape's solver keeps what it promises beside Bullet's on scenes without contact.

Usage: compare_solvers_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest

SCENES = {"hanging", "tablecloth", "trampoline", "rope", "flag", "cape"}


class CompareSolvers(ProgramTest):
    def measured(self, *arguments):
        """Rows by scene, stiffness and method, with numbers where there are any."""
        rows = {}
        for row in self.quick("compare_solvers", *arguments):
            values = {key: float(value) for key, value in row.items() if key.endswith(("_m", "_j", "_s", "_ms"))
                      and value or key.startswith("stretch")}
            rows.setdefault((row["scene"], row["stiffness"]), {})[row["method"]] = {**row, **values}
        return rows

    def test_links_stretch_less_and_gain_no_energy(self):
        rows = self.measured()
        self.assertEqual({scene for scene, _ in rows}, SCENES)
        self.assertEqual({stiffness for _, stiffness in rows}, {"1", "0.3"})
        for case, methods in rows.items():
            self.assertEqual(set(methods), {"bullet", "bullet_shuffled", "bullet_in_substeps", "drape"})
            drape, bullet = methods["drape"], methods["bullet"]
            for key in ("stretch_mean", "stretch_max", "stretch_mean_end", "stretch_max_end"):
                self.assertLessEqual(drape[key], bullet[key], (case, key))
            self.assertEqual(bullet["distance_max_m"], 0)
            self.assertGreater(drape["median_ms"], 0)
            if drape["closed"] == "yes":
                # The scenes have 1 kg and fall by a metre or so: 10 J.
                self.assertLess(drape["energy_gain_j"], 1e-3, case)

    def test_soft_links_hang_as_in_bullet(self):
        """Two solvers agree where links are so soft that a few sweeps solve them."""
        arguments = ("--scene", "trampoline", "--nodes", "9", "--stiffness", "0.01", "--damping", "0.1")
        for case, methods in self.measured(*arguments).items():
            drape, bullet = methods["drape"], methods["bullet"]
            # The middle hangs by 0.4 m.
            self.assertLess(drape["distance_end_m"], 0.005, case)
            self.assertAlmostEqual(drape["stretch_mean_end"], bullet["stretch_mean_end"], delta=0.005)
            self.assertLess(drape["rest_speed_mm_s"], 0.1)

    def test_the_order_of_links_matters_little_beside_substeps(self):
        """Bullet's links in Drape's substeps move like Drape's, with the order of Bullet's links."""
        for case, methods in self.measured("--scene", "trampoline", "--scene", "rope").items():
            drape = methods["drape"]
            self.assertLess(drape["order_distance_mean_m"], 0.05 * drape["distance_mean_m"], case)

    def test_unknown_scenes_are_refused(self):
        self.refused("compare_solvers", ["--scene", "trampolin"], "did you mean trampoline?")


if __name__ == "__main__":
    unittest.main()
