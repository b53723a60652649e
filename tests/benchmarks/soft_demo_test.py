"""soft_demo builds every scene, repeats its results, and finds nothing worse with Drape in the scenes that are quick.

Usage: soft_demo_test.py FOLDER_OF_PROGRAMS
"""
import unittest

from programs import ProgramTest, read_csv, run


class SoftDemo(ProgramTest):
    def test_every_scene_runs_and_clusters_are_bullets(self):
        rows = self.quick("soft_demo", "--steps", "10", "--threads", "1")
        self.assertEqual([row["method"] for row in rows], ["stock", "drape"] * (len(rows) // 2))
        listed = run("soft_demo", "--list").stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in listed], [row["scene"] for row in rows[::2]])
        for row in rows[1::2]:
            self.assertEqual(float(row["invalid"]), 0, row["scene"])
            if row["scene"].startswith("cluster_") or row["scene"] == "tetra_cube":
                self.assertEqual(row["same_bits"], "true", row["scene"])
                self.assertEqual(row["links_left_to_bullet"], row["soft_bodies"], row["scene"])

    def test_outcomes_repeat_and_are_not_worse(self):
        scenes = ["cloth_attach", "cutting", "ropes", "rope_attach", "ropes_on_mesh", "torus"]
        arguments = [word for scene in scenes for word in ("--scene", scene)] + ["--steps", "240", "--threads", "1"]
        first, second = (run("soft_demo", "--check", "--csv", self.path(name), *arguments) for name in ("a", "b"))
        self.assertEqual((first.returncode, second.returncode), (0, 0), first.stderr)
        times = ("min_ms", "median_ms", "p95_ms")
        self.assertEqual(*([{key: value for key, value in row.items() if key not in times}
                            for row in read_csv(self.path(name))] for name in ("a", "b")))

    def test_the_table_for_documents_has_a_line_for_each_scene(self):
        result = run("soft_demo", "--scene", "bending", "--scene", "impact", "--steps", "10", "--markdown", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = result.stdout.splitlines()
        self.assertEqual(len(lines), 4)
        self.assertEqual(len({line.count("|") for line in lines}), 1)

    def test_unknown_scenes_are_refused(self):
        self.refused("soft_demo", ["--scene", "clothe"], "did you mean cloth?")


if __name__ == "__main__":
    unittest.main()
