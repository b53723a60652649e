"""drape_window without a screen: what its screenshots show, and its messages.

Usage: window_test.py DRAPE_WINDOW

Needs Xvfb and Mesa's software OpenGL (xvfb, libgl1-mesa-dri). Tests that need it are skipped without it, or fail if
DRAPE_TEST_NEED_BROWSER is 1, as those of replay pages do. DRAPE_TEST_PAGES names a folder that keeps the screenshots.
"""
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

WINDOW = sys.argv.pop(1)
XVFB = shutil.which("Xvfb")
BUNNY = "/usr/share/glmark2/models/bunny.obj"
SCENES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "scenes")


def read_png(path):
    """Returns the width, the height and the rows of an RGB picture of 8 bits, as bytes."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, stride = zlib.decompress(packed), 3 * width
    rows, before = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        row = unfilter(raw[start], bytearray(raw[start + 1:start + 1 + stride]), before)
        rows.append(bytes(row))
        before = row
    return width, height, rows


def unfilter(kind, row, before):
    for i in range(len(row)):
        left, up, corner = row[i - 3] if i >= 3 else 0, before[i], before[i - 3] if i >= 3 else 0
        if kind == 1:
            row[i] = (row[i] + left) & 255
        elif kind == 2:
            row[i] = (row[i] + up) & 255
        elif kind == 3:
            row[i] = (row[i] + (left + up) // 2) & 255
        elif kind == 4:
            guess = left + up - corner
            near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
            row[i] = (row[i] + near[2]) & 255
    return row


class Display:
    """A display without a screen, while it lives."""

    def __enter__(self):
        read, write = os.pipe()
        self.process = subprocess.Popen([XVFB, "-displayfd", str(write), "-screen", "0", "1280x1024x24", "-nolisten",
                                         "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.name = ":" + number.readline().strip()
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()


def run(arguments, display=None):
    environment = dict(os.environ, LIBGL_ALWAYS_SOFTWARE="1")
    environment.pop("DISPLAY", None)
    if display:
        environment["DISPLAY"] = display
    return subprocess.run([WINDOW, *arguments], env=environment, capture_output=True, text=True, timeout=250)


class Screenshots(unittest.TestCase):
    def setUp(self):
        if not XVFB:
            if os.environ.get("DRAPE_TEST_NEED_BROWSER") == "1":
                self.fail("no Xvfb here (xvfb), and DRAPE_TEST_NEED_BROWSER is 1")
            self.skipTest("no Xvfb here (xvfb)")
        self.folder = os.environ.get("DRAPE_TEST_PAGES") or tempfile.mkdtemp()

    def shoot(self, name, *arguments):
        """Returns the pixels right of the panel, as a list of colours."""
        path = os.path.join(self.folder, name + ".png")
        with Display() as display:
            done = run(["--backend", "host", "--width", "760", "--height", "360", "--screenshot", path, *arguments],
                       display.name)
        self.assertEqual(done.returncode, 0, done.stderr)
        width, height, rows = read_png(path)
        self.assertEqual((width, height), (760, 360))
        return [tuple(row[3 * x:3 * x + 3]) for row in rows for x in range(300, width)]

    @staticmethod
    def count(pixels, is_wanted):
        return sum(1 for pixel in pixels if is_wanted(*pixel))

    def test_shows_the_bunny_and_the_cloth(self):
        if not os.path.exists(BUNNY):
            self.skipTest("no bunny here (glmark2-data)")
        pixels = self.shoot("window_bunny", "--frames", "25", "--detail", "1")
        self.assertGreater(len(set(pixels)), 500)
        blue = self.count(pixels, lambda r, g, b: b > r + 40)
        stone = self.count(pixels, lambda r, g, b: r > b + 8 and r > 90)
        self.assertGreater(blue, 0.02 * len(pixels), "no cloth")
        self.assertGreater(stone, 0.02 * len(pixels), "no bunny")

    def test_shows_contacts_where_it_is_asked_to(self):
        def is_contact(r, g, b):
            return r > 200 and g > 90 and b < 90

        arguments = ["--scene", "ball", "--frames", "32", "--detail", "1"]
        plain = self.shoot("window_plain", *arguments)
        drawn = self.shoot("window_contacts", *arguments, "--draw", "contacts,normals,patches")
        self.assertLess(self.count(plain, is_contact), 20)
        self.assertGreater(self.count(drawn, is_contact), 200)

    def test_shows_a_scene_file(self):
        pixels = self.shoot("window_file", "--scene", os.path.join(SCENES, "table.json"), "--frames", "40")
        self.assertGreater(len(set(pixels)), 200)
        self.assertGreater(self.count(pixels, lambda r, g, b: b > r + 40), 0.02 * len(pixels), "no cloth")

    def test_shows_ropes(self):
        path = os.path.join(self.folder, "rope.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write('{"cloths": [{"shape": {"type": "rope", "from": [0, 1, 0], "to": [1, 1, 0], "nodes": 9},'
                       ' "mass": 1, "pins": [{"edges": ["x_min", "x_max"]}]}]}')
        pixels = self.shoot("window_rope", "--scene", path, "--frames", "5")
        self.assertGreater(self.count(pixels, lambda r, g, b: b > r + 40), 100, "no rope")

    def test_shows_bullets_own_collision(self):
        pixels = self.shoot("window_bullet", "--scene", "ball", "--frames", "5", "--detail", "1",
                            "--collision", "bullet")
        self.assertGreater(len(set(pixels)), 300)


class Messages(unittest.TestCase):
    def test_lists_its_scenes_without_a_display(self):
        done = run(["--list-scenes"])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("bunny\nball\n", done.stdout)

    def test_says_that_there_is_no_display(self):
        done = run(["--scene", "ball", "--frames", "1"])
        self.assertEqual(done.returncode, 1)
        self.assertIn("no display", done.stderr)

    def test_says_which_scene_may_be_meant(self):
        done = run(["--scene", "buny"])
        self.assertEqual(done.returncode, 2)
        self.assertIn("bunny", done.stderr)

    def test_says_what_is_wrong_with_a_scene_file(self):
        done = run(["--scene", os.path.join(SCENES, "missing.json")])
        self.assertEqual(done.returncode, 2)
        self.assertIn("missing.json", done.stderr)

    def test_a_screenshot_needs_a_number_of_frames(self):
        done = run(["--screenshot", "x.png"])
        self.assertEqual(done.returncode, 2)
        self.assertIn("--frames", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
