"""Scene files: the examples satisfy docs/scene.schema.json, and the schema and cloth_drop accept and refuse the same.

Usage: scene_schema_test.py CLOTH_DROP. Exit code 77 means that the module jsonschema is missing.
"""
import copy
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import jsonschema
except ImportError:
    print("the module jsonschema is missing (Debian: python3-jsonschema)")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1)
VALIDATOR = jsonschema.Draft202012Validator(json.loads((ROOT / "docs/scene.schema.json").read_text(encoding="utf-8")))

GRID = {"type": "grid", "columns": 3, "rows": 3, "size": 1}
TRIANGLE = {"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0], "triangles": [0, 1, 2]}
SCENE = {"cloths": [{"shape": GRID, "pins": [{"nodes": [0]}]}],
         "obstacles": [{"shape": {"type": "box", "size": [1, 1, 1]}}]}
TETRAHEDRON = {"type": "mesh", "positions": [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1],
               "triangles": [0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2]}
ROPE = {"type": "rope", "from": [0, 0, 0], "to": [1, 0, 0], "nodes": 3}
POINTS = {"type": "rope", "positions": [0, 0, 0, 1, 0, 0]}
KEYS = {"keyframes": [{"time": 0}, {"time": 1, "rotation": {"axis": [0, 1, 0], "angle": 1}}]}


def changed(path, value):
    """Returns the scene with the value at the path; None removes the key."""
    scene = copy.deepcopy(SCENE)
    place = scene
    *folders, last = path.strip("/").split("/")
    for key in folders:
        place = place[int(key) if isinstance(place, list) else key]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return scene


def shape(kind, **keys):
    return changed("obstacles/0/shape", {"type": kind, **keys})


def cloth(shape, **keys):
    """Returns a scene of one cloth and an obstacle named box."""
    return {"cloths": [{"shape": shape, **keys}],
            "obstacles": [{"name": "box", "shape": {"type": "box", "size": [1, 1, 1]}}]}


GOOD = [
    cloth(ROPE, mass=1), cloth(POINTS, mass=1, material="silk"), cloth({**ROPE, "bending": True}, mass=1),
    cloth(ROPE, mass=1, positions=[0, 0, 0, 1, 1, 0, 2, 0, 0], pins=[{"edges": ["x_min"]}]),
    cloth(TETRAHEDRON, pressure=3), cloth(TETRAHEDRON, volume_conservation=50, pressure=0),
    cloth(GRID, anchors=[]), cloth(GRID, anchors=[{"edges": ["x_min"], "obstacle": "box"}]),
    cloth(ROPE, mass=1, anchors=[{"nodes": [2], "obstacle": "box", "collision": False, "influence": 0.5}]),
    SCENE, {"cloths": [{"shape": TRIANGLE}]}, changed("frames", 3.0), changed("gravity", [0, 0, 1.5]),
    changed("wind", {"velocity": [1, 0, 0], "drag": 0}), changed("materials", {"mine": {"base": "silk"}}),
    changed("cloths/0/material", {"base": "rubber", "density": 1}), changed("cloths/0/rest", "start"),
    changed("cloths/0/rotation", {"axis": [0, 3, 0], "angle": -7}), changed("cloths/0/pins", []),
    changed("cloths/0/pins/0/motion", KEYS), changed("cloths/0/pins/0/motion", {"velocity": [1, 0, 0], "from": 1}),
    changed("cloths/0/pins/0/edges", ["z_max"]), changed("cloths/0/pins/0/corners", ["x_min_z_max"]),
    changed("obstacles/0/motion", KEYS), changed("obstacles/0/mass", 2), shape("sphere", radius=1),
    shape("capsule", radius=1, length=1), shape("cylinder", radius=1, length=1), shape("plane"),
    shape("plane", normal=[1, 1, 0], offset=-1), shape("built_in", name="torus", fit=2),
    shape("height_field", columns=2, rows=2, cell=1, heights=[0, 0, 0, 1]),
    changed("obstacles/0/shape", {**TRIANGLE, "scale": 2}), changed("recording", {"csv": "out.csv"}),
    changed("obstacles", []), changed("name", "é"),
]

BAD = [
    cloth(ROPE), cloth({"type": "rope"}, mass=1), cloth({**ROPE, "nodes": 1}, mass=1),
    cloth({**ROPE, **POINTS}, mass=1), cloth({**POINTS, "nodes": 2}, mass=1),
    cloth({"type": "rope", "from": [0, 0, 0], "nodes": 3}, mass=1), cloth({**ROPE, "bending": 0.1}, mass=1),
    cloth({"type": "rope", "positions": [0, 0, 0]}, mass=1), cloth({**ROPE, "length": 1}, mass=1),
    cloth(TETRAHEDRON, pressure=-1), cloth(TETRAHEDRON, volume_conservation="1"), cloth(GRID, pressure=1),
    cloth(ROPE, mass=1, volume_conservation=1), cloth(GRID, anchors={}), cloth(GRID, anchors=[{"nodes": [0]}]),
    cloth(GRID, anchors=[{"obstacle": "box"}]), cloth(GRID, anchors=[{"nodes": [0], "obstacle": 0}]),
    cloth(GRID, anchors=[{"nodes": [0], "obstacle": "box", "influence": 0}]),
    cloth(GRID, anchors=[{"nodes": [0], "obstacle": "box", "collision": 1}]),
    cloth(GRID, anchors=[{"nodes": [0], "obstacle": "box", "motion": KEYS}]),
    [], 3, {}, changed("cloths", []), changed("cloths", {}), changed("frame", 3), changed("frames", 0),
    changed("frames", 2.5), changed("frames", "3"), changed("frames", True), changed("time_step", 0),
    changed("time_step", 2), changed("thickness", 0), changed("iterations", 1001), changed("gravity", [0, 1]),
    changed("gravity", 9.81), changed("gravity", [0, "1", 0]), changed("self_collision", 1), changed("name", ""),
    changed("wind", {}), changed("wind", {"velocity": [1, 0, 0], "dragg": 1}), changed("materials", []),
    changed("materials", {"mine": "silk"}), changed("materials", {"": {}}),
    changed("materials", {"mine": {"stretch": 0}}), changed("materials", {"mine": {"friction": 2}}),
    changed("cloths/0/shape", None), changed("cloths/0/shape", "grid"), changed("cloths/0/shape", {"columns": 3}),
    changed("cloths/0/shape", {"type": "gird"}), changed("cloths/0/shape", {**GRID, "columns": 1}),
    changed("cloths/0/shape", {**GRID, "width": 1}), changed("cloths/0/shape", {"type": "mesh"}),
    changed("cloths/0/shape", {"type": "mesh", "file": "a.obj", "positions": [0] * 9, "triangles": [0, 1, 2]}),
    changed("cloths/0/shape", {**TRIANGLE, "scale": 2, "fit": 1}),
    changed("cloths/0/shape", {**TRIANGLE, "join": True}),
    changed("cloths/0/shape", {"type": "box", "size": [1, 1, 1]}), changed("cloths/0/material", 3),
    changed("cloths/0/material", {"bend": 1}), changed("cloths/0/mass", 0), changed("cloths/0/rest", "now"),
    changed("cloths/0/margin", 0), changed("cloths/0/position", [1, 2, 1e5]), changed("cloths/0/rotation", 3),
    changed("cloths/0/rotation", {"angle": 3}), changed("cloths/0/pins", {}), changed("cloths/0/pins", [{}]),
    changed("cloths/0/pins", [{"nodes": []}]), changed("cloths/0/pins", [{"nodes": [-1]}]),
    changed("cloths/0/pins", [{"corners": ["x_min"]}]), changed("cloths/0/pins", [{"edges": ["left"]}]),
    changed("cloths/0/pins", [{"box": {"min": [0, 0, 0]}}]), changed("cloths/0/pins/0/motion", {}),
    changed("cloths/0/pins/0/motion", {"keyframes": []}),
    changed("cloths/0/pins/0/motion", {**KEYS, "velocity": [1, 0, 0]}),
    changed("cloths/0/pins/0/motion", {"velocity": [1, 0, 0], "interpolation": "smooth"}),
    changed("cloths/0/pins/0/motion", {**KEYS, "interpolation": "cubic"}),
    changed("cloths/0/pins/0/motion", {"keyframes": [{"shift": [0, 0, 0]}]}),
    changed("cloths/0/pins/0/motion", {"keyframes": [{"time": -1}]}),
    changed("obstacles/0/shape", GRID), shape("box"), shape("box", size=[1, 0, 1]), shape("sphere", radius=-1),
    shape("sphere", radius=1, length=1), shape("capsule", radius=1), shape("built_in", name="teapot"),
    shape("height_field", columns=2, rows=2, cell=1), shape("plane", offset="1"),
    changed("obstacles/0/velocity", [1, 0, 0]), changed("obstacles/0/friction", -1),
    {**SCENE, "obstacles": [{**SCENE["obstacles"][0], "mass": 1, "motion": KEYS}]},
    {**SCENE, "obstacles": [{"shape": {"type": "plane"}, "mass": 1}]},
    {"cloths": [{"shape": TRIANGLE, "positions": [0] * 9, "position": [0, 0, 0]}]},
    changed("recording", {"video": "a"}), changed("recording", {"csv": 1}),
    changed("recording", {"csv": "/tmp/out.csv"}), changed("recording", {"replay": "a/../../b.html"}),
]


def keys_of(schema):
    """Returns the keys of all objects that a schema describes."""
    keys = set()
    for name, part in schema.items() if isinstance(schema, dict) else enumerate(schema):
        if name == "properties":
            keys |= part.keys()
        if isinstance(part, (dict, list)):
            keys |= keys_of(part)
    return keys - {"type"}


def accepts(path):
    """Returns whether cloth_drop reads the scene file, and its line on standard error."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run([PROGRAM, "--scene", path, "--write-scene", f"{folder}/out.json"], capture_output=True,
                             text=True, check=False)
    return run.returncode == 0, run.stderr


class SceneSchema(unittest.TestCase):
    def test_the_schema_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(VALIDATOR.schema)

    def test_examples_satisfy_the_schema_and_are_read(self):
        examples = sorted((ROOT / "examples/scenes").glob("*.json"))
        self.assertGreaterEqual(len(examples), 3)
        for path in examples:
            VALIDATOR.validate(json.loads(path.read_text(encoding="utf-8")))
            good, error = accepts(str(path))
            self.assertTrue(good, error)

    def test_the_example_of_the_page_is_read(self):
        page = (ROOT / "docs/scene_files.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```json\n(.*?)```", page, re.DOTALL)
        self.assertEqual(len(blocks), 1)
        VALIDATOR.validate(json.loads(blocks[0]))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "scene.json")
            path.write_text(blocks[0], encoding="utf-8")
            good, error = accepts(str(path))
            self.assertTrue(good, error)

    def test_the_page_and_the_schema_have_the_same_keys(self):
        page = (ROOT / "docs/scene_files.md").read_text(encoding="utf-8")
        for key in keys_of(VALIDATOR.schema):
            self.assertTrue(f"`{key}`" in page or f'"{key}"' in page, f"{key} is not on the page")

    def test_the_reader_and_the_schema_agree(self):
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/scene.json"
            for wanted, scenes in ((True, GOOD), (False, BAD)):
                for scene in scenes:
                    with open(path, "w", encoding="utf-8") as file:
                        json.dump(scene, file)
                    self.assertEqual(VALIDATOR.is_valid(scene), wanted, f"schema: {scene}")
                    good, error = accepts(path)
                    self.assertEqual(good, wanted, f"reader: {scene}: {error}")

    def test_written_scenes_satisfy_the_schema(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("funnel", "dressed", "knot"):
                path = f"{folder}/{name}.json"
                subprocess.run([PROGRAM, "--scene", name, "--write-scene", path], check=True)
                with open(path, encoding="utf-8") as file:
                    VALIDATOR.validate(json.load(file))


if __name__ == "__main__":
    unittest.main()
