"""Replay pages of cloth_drop: their numbers, their size, and what a browser draws of them.

Usage: replay_test.py CLOTH_DROP

Tests that need Chromium are skipped without it, or fail if DRAPE_TEST_NEED_BROWSER is 1. DRAPE_TEST_PAGES names a
folder that keeps the pages and screenshots.
"""
import base64
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

CLOTH_DROP = sys.argv.pop(1)
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
THREE = "/usr/share/javascript/three"
BUNNY = "/usr/share/glmark2/models/bunny.obj"
MOST_BYTES = 1500000  # limit for 240 frames on the bunny, beside three.js


class Reader:
    """Decodes the numbers of a page, in other words than its own decode.js."""

    def __init__(self, data, at):
        self.data, self.at = data, at

    def number(self):
        value = shift = 0
        while True:
            byte = self.data[self.at]
            self.at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value >> 1 if value % 2 == 0 else -(value >> 1) - 1

    def rows(self, width, count):
        rows = []
        for _ in range(count):
            mode = self.data[self.at]
            self.at += 1
            row = [self.number() for _ in range(width)]
            if mode >= 3:
                for i in range(1, width):
                    row[i] += row[i - 1]
            if mode % 3 == 1:
                row = [value + one for value, one in zip(row, rows[-1])]
            elif mode % 3 == 2:
                row = [value + 2 * one - two for value, one, two in zip(row, rows[-1], rows[-2])]
            rows.append(row)
        return rows

    def triangles(self, count):
        triangles, gates, vertices = [], [], 0

        def vertex(code):
            nonlocal vertices
            if code == 1:
                vertices += 1
                return vertices - 1
            return vertices + 1 - code

        while len(triangles) < count:
            if not gates:
                a, b, c = (vertex(self.number()) for _ in range(3))
                gates += [(b, a), (c, b), (a, c)]
                triangles.append((a, b, c))
                continue
            start, end = gates.pop()
            code = self.number()
            if code:
                third = vertex(code)
                triangles.append((start, end, third))
                gates += [(third, end), (start, third)]
        return triangles


class Page:
    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.text = file.read()
        packed = re.search(r'<script id="data" type="text/plain">([^<]*)</script>', self.text).group(1)
        data = zlib.decompress(base64.b64decode(packed))
        length = struct.unpack_from("<I", data)[0]
        self.replay = json.loads(data[4:4 + length])
        self.arrays = data[4 + length:]

    def at(self, offset):
        return Reader(self.arrays, offset)

    def soft(self, run=0):
        """Returns the first soft body, its mesh, and the x, y and z of its vertices, frame by frame, in steps."""
        body = next(body for body in self.replay["runs"][run]["bodies"] if not body["rigid"])
        mesh = self.replay["meshes"][body["mesh"]]
        rows = self.at(body["positions"]).rows(3 * mesh["vertices"], body["frames"])
        count = mesh["vertices"]
        return body, mesh, [[row[k * count:(k + 1) * count] for k in range(3)] for row in rows]


def read_point_cache(path):
    with open(path, "rb") as file:
        data = file.read()
    points, samples = struct.unpack_from("<i", data, 16)[0], struct.unpack_from("<i", data, 28)[0]
    values = struct.unpack_from(f"<{3 * points * samples}f", data, 32)
    return [[values[3 * (frame * points + i):][:3] for i in range(points)] for frame in range(samples)]


def read_png(path):
    """Returns the rows of a PNG file without interlacing, each as bytes, and the bytes of a pixel."""
    with open(path, "rb") as file:
        data = file.read()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        chunk = data[at + 8:at + 8 + length]
        at += 12 + length
        if kind == b"IHDR":
            width, _, depth, colour = struct.unpack_from(">IIBB", chunk)
            assert depth == 8 and colour in (2, 6)
            size = 3 if colour == 2 else 4
        elif kind == b"IDAT":
            packed += chunk
    raw, rows, before = zlib.decompress(packed), [], bytearray(width * size)
    for start in range(0, len(raw), 1 + width * size):
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + width * size])
        for i in range(len(row) if kind else 0):
            left, up = row[i - size] if i >= size else 0, before[i]
            if kind == 4:
                corner = before[i - size] if i >= size else 0
                guess = left + up - corner
                nearest = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
                row[i] = (row[i] + nearest[2]) & 255
            else:
                row[i] = (row[i] + (left, up, (left + up) // 2)[kind - 1]) & 255
        rows.append(bytes(row))
        before = row
    return rows, size


def pixels_like(image, wanted):
    """Returns how many pixels `wanted` accepts (r, g, b)."""
    rows, size = image
    return sum(wanted(*row[i:i + 3]) for row in rows for i in range(0, len(row), size))


def pixels_changed(one, other):
    size = one[1]
    return sum(row[i:i + size] != changed[i:i + size]
               for row, changed in zip(one[0], other[0]) for i in range(0, len(row), size))


def is_red(red, green, blue):
    return red > 110 and green < 0.5 * red and blue < 0.6 * red


def is_painted(red, green, blue):
    """The colours of the scales, which neither cloth, stone nor sky have."""
    return max(red, green, blue) - min(red, green, blue) > 90 and not is_red(red, green, blue)


class ReplayTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = os.environ.get("DRAPE_TEST_PAGES")
        if cls.folder:
            os.makedirs(cls.folder, exist_ok=True)
        else:
            temporary = tempfile.TemporaryDirectory()
            cls.addClassCleanup(temporary.cleanup)
            cls.folder = temporary.name
        cls.page = cls.path("page.html")
        if os.path.exists(f"{THREE}/three.min.js"):
            cls.drop("--cloth", "13x13", "--steps", "40", "--compare", "--replay", cls.page,
                     "--point-cache", cls.path("cache"))

    def setUp(self):
        if not os.path.exists(f"{THREE}/three.min.js"):
            self.skipTest("no three.js here (libjs-three)")

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @staticmethod
    def drop(*options):
        return subprocess.run([CLOTH_DROP, "--backend", "host", "--quiet", *options], capture_output=True, text=True,
                              timeout=800, check=True)

    def test_positions_are_those_of_the_point_cache_within_half_of_the_resolution(self):
        page = Page(self.page)
        _, mesh, frames = page.soft()
        step = page.replay["step"]
        exact = read_point_cache(self.path("cache/001_cloth_2.pc2"))
        self.assertEqual(len(frames), 41)
        self.assertEqual(len(exact), 41)
        # The page has its own order of the vertices: match them at the start, where the cloth is flat.
        at = {tuple(round(value / step) for value in point): i for i, point in enumerate(exact[0])}
        order = [at[point] for point in zip(*frames[0])]
        self.assertEqual(sorted(order), list(range(13 * 13)))
        worst = max(abs(step * frames[frame][axis][i] - exact[frame][order[i]][axis])
                    for frame in range(41) for axis in range(3) for i in range(13 * 13))
        self.assertLessEqual(worst, 0.5 * step * (1 + 1e-6) + 1e-7)
        with open(self.path("cache/001_cloth_2.obj")) as file:
            faces = [tuple(int(word) - 1 for word in line.split()[1:]) for line in file if line.startswith("f ")]

        def turned(face):
            first = face.index(min(face))
            return face[first:] + face[:first]

        triangles = page.at(mesh["walk"]).triangles(mesh["triangles"])
        own = [tuple(order[vertex] for vertex in triangle) for triangle in triangles]
        self.assertEqual(sorted(map(turned, own)), sorted(map(turned, faces)))

    def test_all_runs_are_there_and_share_the_obstacle(self):
        replay = Page(self.page).replay
        self.assertEqual([run["title"] for run in replay["runs"]], ["Drape, host", "Bullet (stock)", "Bullet (tuned)"])
        self.assertEqual(len(replay["meshes"]), 2)
        for run in replay["runs"]:
            channels = next(body for body in run["bodies"] if not body["rigid"])["channels"]
            self.assertEqual([channel["name"] for channel in channels], ["contact", "gap", "stretch"])

    def test_nodes_of_drape_are_in_contact_and_never_below_the_thickness(self):
        page = Page(self.page)
        body, mesh, _ = page.soft()
        contact, gap, _ = (page.at(channel["levels"]).rows(mesh["vertices"], body["frames"])
                           for channel in body["channels"])
        self.assertNotIn(255, contact[0])
        self.assertIn(255, contact[-1])
        # Level 128 is a gap of 0; 12 levels are 4 mm.
        self.assertTrue(all(level == 0 or level > 116 for level in gap[-1]))
        self.assertTrue(any(level > 0 for level in gap[-1]))

    def test_the_bunny_fits(self):
        if not os.path.exists(BUNNY):
            self.skipTest(f"{BUNNY} is missing (glmark2-data)")
        path = self.path("bunny.html")
        self.drop("--obstacle", BUNNY, "--steps", "240", "--replay", path)
        library = sum(os.path.getsize(f"{THREE}/{name}")
                      for name in ("three.min.js", "examples/js/controls/OrbitControls.js"))
        self.assertLess(os.path.getsize(path) - library, MOST_BYTES)

    def test_outputs_with_other_endings_are_refused(self):
        for option, name in (("--replay", "a.png"), ("--gltf", "a.gltf"), ("--animation", "a.gif")):
            result = subprocess.run([CLOTH_DROP, option, self.path(name)], capture_output=True, text=True)
            self.assertEqual(result.returncode, 2)
            self.assertIn(option, result.stderr)

    def test_an_animation_has_its_frames(self):
        path = self.path("a.webp")
        self.drop("--cloth", "5x5", "--steps", "6", "--animation", path)
        with open(path, "rb") as file:
            data = file.read()
        self.assertEqual((data[:4], data[8:16]), (b"RIFF", b"WEBPVP8X"))
        self.assertEqual(data.count(b"ANMF"), 4)  # frames 0, 2, 4 and 6


class BrowserTest(ReplayTest):
    """Chromium draws a page."""

    def setUp(self):
        super().setUp()
        if BROWSER:
            return
        if os.environ.get("DRAPE_TEST_NEED_BROWSER") == "1":
            self.fail("no Chromium here (chromium), and DRAPE_TEST_NEED_BROWSER is 1")
        self.skipTest("no Chromium here (chromium)")

    def browse(self, page, *options, budget=20000):
        with tempfile.TemporaryDirectory() as profile:
            return subprocess.run(
                [BROWSER, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                 "--hide-scrollbars", f"--user-data-dir={profile}", f"--virtual-time-budget={budget}", *options, page],
                capture_output=True, text=True, timeout=300, check=True).stdout

    def screenshot(self, name, choices, size="900,600"):
        path = self.path(name)
        if not os.path.exists(path):
            self.browse(f"file://{self.page}#{choices}", f"--window-size={size}", f"--screenshot={path}")
        return read_png(path)

    def test_the_cloth_is_drawn_and_moves(self):
        start = self.screenshot("start.png", "frame=0&mesh=")
        end = self.screenshot("end.png", "frame=40&mesh=")
        for image in (start, end):
            self.assertGreater(pixels_like(image, is_red), 3000)
        self.assertGreater(pixels_changed(start, end), 5000)

    def test_each_colour_is_another_picture(self):
        images = [self.screenshot(f"{name}.png", f"frame=40&colour={name}&mesh=")
                  for name in ("contact", "gap", "stretch")]
        for image in images:
            self.assertGreater(pixels_like(image, is_painted), 300)
        for i, image in enumerate(images):
            self.assertNotEqual(image, images[i - 1])

    def test_the_wireframe_is_drawn_on_the_cloth_or_on_everything(self):
        plain, cloth, everything = (self.screenshot(f"{name}.png", f"frame=40&mesh={mesh}")
                                    for name, mesh in (("end", ""), ("edges", "cloth"), ("everything", "all")))
        self.assertGreater(pixels_changed(plain, cloth), 1000)
        self.assertGreater(pixels_changed(plain, everything), 1.5 * pixels_changed(plain, cloth))

    def test_a_phone_shows_the_runs_above_one_another(self):
        rows, size = self.screenshot("phone.png", "frame=0&mesh=", "500,900")
        thirds = [rows[i * 240:(i + 1) * 240] for i in range(3)]
        for third in thirds:
            self.assertGreater(pixels_like((third, size), is_red), 500)

    def probe(self, script):
        """Runs a script in the page once it is drawn, and returns what the script assigns to `probe`."""
        path = self.path("probe.html")
        with open(self.page, encoding="utf-8") as file:
            text = file.read()
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace("</body>", """<script>
              const started = setInterval(async () => {
                if (!window.player) return;
                clearInterval(started);
                let probe;
                %s
                document.body.dataset.probe = JSON.stringify(probe);
              }, 50);</script></body>""" % script))
        dom = self.browse(f"file://{path}", "--window-size=300,300", "--dump-dom", budget=200000)
        return json.loads(re.search(r'data-probe="([^"]*)"', dom).group(1).replace("&quot;", '"'))

    def test_controls_play_and_seek(self):
        found = self.probe("""
          const time = document.getElementById("time"), play = document.getElementById("play");
          probe = [];
          // Chromium draws no further frames for --dump-dom.
          window.requestAnimationFrame = draw => setTimeout(() => draw(performance.now()), 16);
          const wait = async expected => {
            for (let i = 0; i < 1000 && document.body.dataset.frame !== expected; ++i)
              await new Promise(done => setTimeout(done, 50));
            probe.push(document.body.dataset.frame, play.getAttribute("aria-label"));
          };
          play.click();
          await wait("40");
          time.value = 7;
          time.dispatchEvent(new Event("input"));
          await wait("7");
          window.dispatchEvent(new KeyboardEvent("keydown", {key: "ArrowRight"}));
          await wait("8");""")
        self.assertEqual(found, ["40", "Play", "7", "Play", "8", "Play"])

    def test_the_page_decodes_what_python_decodes(self):
        page = Page(self.page)
        frames = [page.soft(run)[2] for run in range(3)]
        found = self.probe("""
          const replay = player.replay;
          const sum = body => body.positions.reduce((a, b) => a + Math.abs(b), 0);
          const sums = replay.runs.map(run => sum(run.bodies.filter(body => !body.rigid)[0]));
          const corners = replay.meshes.map(mesh => mesh.corners.reduce((a, b, i) => (a * 31 + b + i) % 1000003, 0));
          probe = {sums, corners};""")
        self.assertEqual(found["sums"],
                         [sum(abs(v) for frame in run for axis in frame for v in axis) for run in frames])
        for mesh, expected in zip(page.replay["meshes"], found["corners"]):
            value = 0
            flat = [v for triangle in page.at(mesh["walk"]).triangles(mesh["triangles"]) for v in triangle]
            for i, v in enumerate(flat):
                value = (value * 31 + v + i) % 1000003
            self.assertEqual(value, expected)


def load_tests(loader, _tests, _pattern):
    """Runs the tests of the numbers once, not again in the browser's class."""
    names = set(loader.getTestCaseNames(BrowserTest)) - set(loader.getTestCaseNames(ReplayTest))
    return unittest.TestSuite([loader.loadTestsFromTestCase(ReplayTest), *map(BrowserTest, sorted(names))])


if __name__ == "__main__":
    unittest.main()
