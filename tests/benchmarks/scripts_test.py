"""The scripts that run cloth_drop and drape_check write what they measured, and tables are made of it.

Usage: scripts_test.py FOLDER_OF_PROGRAMS
"""
import json
import os
import struct
import subprocess
import unittest

from programs import PROGRAMS, ProgramTest


class Scripts(ProgramTest):
    """cloth_drop.sh, drop_speeds.sh and drape_check.sh, and the tables of what they write."""

    @staticmethod
    def bash(name, *arguments, **environment):
        path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "benchmarks", name)
        return subprocess.run(["bash", path, *arguments], capture_output=True, text=True, timeout=600,
                              env={**os.environ, "BIN": PROGRAMS, **environment})

    def content(self, name):
        with open(self.path(f"results/machine/{name}.json")) as file:
            content = json.load(file)
        machine = content["machine"]
        self.assertTrue(machine["processor"] and machine["date"])
        self.assertEqual(machine["cores"], os.cpu_count())
        for device in machine["devices"]:
            self.assertTrue(device["device"] and device["driver"], device)
        return content

    def tables(self):
        """Returns the summary of what was measured."""
        csv = self.path("machine.csv")
        self.assertEqual(self.script("benchmarks/reduce.py", self.path("results/machine"), csv).returncode, 0)
        result = self.script("benchmarks/report.py", csv)
        self.assertEqual(result.returncode, 0, result.stderr)
        return self.read("machine.md")

    @staticmethod
    def answers(content, question):
        return [row for row in content["rows"] if row["question"] == question]

    def cloth_drop(self, *options, **environment):
        if not os.path.exists(os.path.join(PROGRAMS, "cloth_drop")):
            self.skipTest("cloth_drop is not built")
        return self.bash("cloth_drop.sh", self.path("results/machine"), *options,
                         **{"BUNNY": "stairs", "STEPS": "20", "COMMIT": "abc1234", **environment})

    def test_the_scene_on_every_back_end(self):
        result = self.cloth_drop("--cloth", "9x9")
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("cloth_drop")
        self.assertEqual(content["scene"],
                         {"obstacle": "stairs", "obstacle_digest": "stairs", "options": ["--cloth", "9x9"]})
        names = [device["device"] for device in content["machine"]["devices"]] + ["host"]
        drape = [row for row in content["rows"] if row["run"] == "drape"]
        self.assertEqual([row["device"] for row in drape], names)
        self.assertEqual({row["run"] for row in content["rows"]}, {"drape", "bullet_stock", "bullet_tuned"})
        for row in drape:
            self.assertEqual((row["steps"], row["cloth_triangles"], row["nodes_through"]), (20, 128, 0))
            self.assertGreater(row["collision_ms"]["median"], 0)
        text = self.tables()
        for words in ("| Drape, host, --cloth 9x9 | host |", "| Bullet's own, tuned, --cloth 9x9 | host |",
                      f"`{drape[0]['hash']}`"):
            self.assertIn(words, text)

    def test_the_scene_without_bullet(self):
        self.assertEqual(self.cloth_drop("--no-compare", STEPS="2").returncode, 0)
        self.assertEqual({row["run"] for row in self.content("cloth_drop")["rows"]}, {"drape"})
        self.assertEqual(self.cloth_drop("--no-such-option", STEPS="2").returncode, 1)

    def test_a_scene_that_is_never_in_contact_has_no_times(self):
        result = self.cloth_drop("--cloth", "9x9", "--drop-height", "1", "--no-compare", STEPS="1")
        self.assertEqual(result.returncode, 0, result.stderr)
        for row in self.content("cloth_drop")["rows"]:
            self.assertIsNone(row["collision_ms"])
        self.assertRegex(self.tables(), r"\| Drape, host, \S.* \| host \| – \| – \| 0 \|")

    def test_back_ends_that_differ_are_told(self):
        """A program whose hash is its back end's."""
        with open(self.path("cloth_drop"), "w") as file:
            file.write(f"""#!/usr/bin/env bash
[[ $* != *--list-devices* ]] || {{ echo "some device (a platform, driver 1)"; exit; }}
hash=0000000000000001
[[ $* != *"--backend host"* ]] || hash=0000000000000002
"{PROGRAMS}/cloth_drop" --obstacle stairs --cloth 9x9 --steps 2 --backend host --quiet --json - | sed "s/[0-9a-f]\\{{16\\}}/$hash/"
""")
        os.chmod(self.path("cloth_drop"), 0o755)
        result = self.cloth_drop("--no-compare", BIN=self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("hashes differ at abc1234", result.stderr)
        self.assertRegex(result.stderr, r"0000000000000002 \(.*drape_host\)")

    def drops(self, **environment):
        if not os.path.exists(os.path.join(PROGRAMS, "cloth_drop")):
            self.skipTest("cloth_drop is not built")
        result = self.bash("drop_speeds.sh", self.path("results/machine"), "--backend", "host", "--cloth", "9x9",
                           BUNNY="stairs", SPEEDS="2 50", COMMIT="abc1234", **environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("drop_speeds")
        self.assertEqual(content["machine"]["commit"], "abc1234")
        self.assertEqual([(row["speed_m_s"], row["run"]) for row in content["rows"]],
                         [(speed, run) for speed in (2, 50)
                          for run in ("automatic", "continuous", "discrete", "stock", "tuned")])
        return content["rows"]

    def test_drops_at_every_speed(self):
        for row in self.drops(STEPS="3"):
            self.assertEqual((row["ended"], row["steps"]), ("whole", 3), row)
            self.assertLessEqual(row["nodes_below_surface"], row["nodes_below_surface_max"])
            if row["run"] in ("automatic", "continuous"):
                self.assertEqual((row["nodes_below_surface_max"], row["nodes_through"]), (0, 0), row)
            elif row["run"] == "stock" and row["speed_m_s"] == 50:
                self.assertGreater(row["nodes_through"], 0, "a child's")
            elif row["run"] == "discrete" and row["speed_m_s"] == 50:
                self.assertGreater(row["nodes_below_surface_max"], row["nodes_below_surface"],
                                   "not the last step alone")
                self.assertGreater(row["nodes_through"], row["nodes_below_surface_max"])
                through = f" / {row['nodes_through']} / "
        text = self.tables()
        self.assertIn("|  | 2 m/s --cloth 9x9 | 50 m/s --cloth 9x9 |", text)
        self.assertIn(through, text)
        self.assertIn("drop_speeds abc1234", text)
        self.assertNotIn(", 3 steps", text)

    def test_drops_that_reach_their_limit_keep_their_steps(self):
        for row in self.drops(STEPS="40", LIMIT="1e-9"):
            self.assertEqual(row["ended"], "by the time limit", row)
            built_in = row["run"] in ("stock", "tuned")
            self.assertEqual(row["steps"], 0 if built_in else 1, "Bullet's step in hand is given up")
            if row["run"] == "automatic":
                self.assertEqual(row["intersecting_pairs_max"], 0)
        self.assertIn(", 1 steps", self.tables())

    def truth(self):
        """Records with a hit each and, of the triangles, an answer that is wrong; a mesh that passes itself."""
        folder = self.path("truth")
        os.makedirs(folder)
        face = [0, 0, 0, 4, 0, 0, 0, 4, 0]
        motion = struct.pack("<24f2i", 1, 1, 1, *face, 1, 1, -1, *face, 0, 1)
        through = struct.pack("<18fi", *face, 0, 0, -1, 1, 0, 0, 0, 1, 0, 1)
        above = struct.pack("<18fi", *face, 0, 0, 1, 1, 0, 2, 0, 1, 2, 1)
        for name, records in (("ccd_queries.bin", motion), ("triangle_pairs.bin", through + above)):
            with open(os.path.join(folder, name), "wb") as file:
                file.write(records)
        for name, height in (("cloth_ball92.ply", 1), ("cloth_ball93.ply", -1)):
            with open(os.path.join(folder, name), "w") as file:
                file.write("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                           "property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
                           f"0 0 0\n4 0 0\n0 4 0\n0.5 0.5 {height}\n1 0.5 {height}\n0.5 1 {height}\n3 0 1 2\n3 3 4 5\n")
        return folder

    def test_published_queries_on_every_back_end(self):
        result = self.bash("drape_check.sh", self.path("results/machine"), "--truth", self.truth(), "--commit",
                           "abc1234")
        self.assertEqual(result.returncode, 0, result.stderr)
        content = self.content("drape_check")
        names = ["host"] + [device["device"] for device in content["machine"]["devices"]]
        self.assertEqual([row["device"] for row in self.answers(content, "ccd")], names)
        self.assertEqual([(row["mode"], row["device"]) for row in self.answers(content, "triangles")],
                         [(mode, name) for mode in ("fast", "exact") for name in names])
        self.assertEqual({(row["misses"], row["false_hits"]) for row in self.answers(content, "ccd")}, {(0, 0)})
        self.assertEqual({(row["misses"], row["false_hits"]) for row in self.answers(content, "triangles")}, {(1, 0)})
        self.assertEqual([(row["mode"], row["device"], row["intersecting_pairs"])
                          for row in self.answers(content, "pairs")],
                         [(mode, name, count) for mode, count in (("frame 92", 0), ("frame 93", 0), ("92 and 93", 1))
                          for name in names])
        self.assertEqual({(row["device"], row["vf_hits"]) for row in self.answers(content, "step")},
                         {(name, 3) for name in names})
        text = self.tables()
        self.assertIn("| triangles exact | host | 2 | 1 | 0 |", text)
        self.assertIn("| ccd | host | 1 | 0 | 0 |", text)
        self.assertRegex(text, r"\| pairs 92 and 93 \| host \| \d+ \| – \| – \| 1 \|")
        self.assertIn("drape_check abc1234", text)

    def test_queries_that_are_not_there_are_named(self):
        folder = self.truth()
        os.remove(os.path.join(folder, "ccd_queries.bin"))
        result = self.bash("drape_check.sh", self.path("results/machine"), "--truth", folder)
        self.assertEqual(result.returncode, 1)
        self.assertIn("ccd_queries.bin", result.stderr)
        content = self.content("drape_check")
        self.assertFalse(self.answers(content, "ccd"))
        self.assertTrue(self.answers(content, "triangles"))
        self.assertEqual(self.bash("drape_check.sh", self.path("results/machine")).returncode, 2)


if __name__ == "__main__":
    unittest.main()
