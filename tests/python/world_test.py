"""ClothWorld: the bits of a world of Bullet's, views without copies, their lifetime, threads, and errors."""
import gc
import subprocess
import sys
import threading
import weakref

import numpy
import pytest

import drape

DT = 1 / 60


@pytest.fixture
def world(host):
    return drape.ClothWorld(host)


def test_steps_are_those_of_cpp(world, reference):
    cloth = world.add_cloth(*reference.mesh("sheet")[:2], pins=[5], mass=1.5, thickness=0.024, stiffness=0.9,
                            bending_stiffness=0.1, friction=0.4, damping=0.03, iterations=4)
    ball = world.add_mesh(*reference.mesh("ball")[:2])
    positions, velocities = world.positions(cloth), world.velocities(cloth)
    for rotation in reference.array("rotations", numpy.float64, -1, 4):
        world.set_pose(ball, (0, 0, 0), rotation)
        assert world.step(DT) == drape.StepStatus.GOOD
    assert world.statistics["contacts"] > 50
    assert numpy.array_equal(positions, reference.array("positions", positions.dtype, -1, 3))
    assert numpy.array_equal(velocities, reference.array("velocities", velocities.dtype, -1, 3))


def test_positions_are_a_view_without_a_copy(world, sheet):
    cloth = world.add_cloth(*sheet[:2])
    before = world.positions(cloth)
    assert before.shape == (81, 3) and before.strides[0] > 3 * before.itemsize
    assert numpy.array_equal(before, sheet.positions)
    world.step()
    after = world.positions(cloth)
    assert numpy.shares_memory(before, after)
    assert numpy.array_equal(before, after) and before[0, 1] < 0.3
    assert numpy.allclose(world.normals(cloth), (0, 1, 0))
    assert not before.flags.writeable
    with pytest.raises(ValueError):
        before[0] = 0
    with pytest.raises(ValueError):
        before.setflags(write=True)


@pytest.mark.parametrize("end", ["removed", "world gone"])
def test_views_outlive_their_world(host, sheet, end):
    world = drape.ClothWorld(host)
    cloth = world.add_cloth(*sheet[:2])
    world.step()
    positions, velocities = world.positions(cloth), world.velocities(cloth)
    kept = positions.copy(), velocities.copy()
    if end == "removed":
        world.remove_cloth(cloth)
        world.step()
    else:
        gone = weakref.ref(world)
        del world
        gc.collect()
        assert gone() is None
    other = drape.ClothWorld(host)
    other.add_cloth(*sheet[:2])
    other.step()
    assert numpy.array_equal(positions, kept[0]) and numpy.array_equal(velocities, kept[1])


def test_cloth_rests_at_half_its_thickness_and_the_margin(world, sheet, plate):
    cloth = world.add_cloth(*sheet[:2], thickness=0.04)
    below = world.add_mesh(*plate[:2], margin=0.03)
    for _ in range(90):
        world.step(DT)
    assert abs(world.positions(cloth)[:, 1].mean() - 0.05) < 0.003
    contacts = world.contacts()
    assert len(contacts) == world.statistics["contacts"] > 0
    assert set(contacts["cloth"]) == {cloth} and set(contacts["obstacle"]) == {below}
    assert numpy.allclose(contacts["normal"], (0, 1, 0), atol=1e-4)
    assert numpy.allclose(contacts["thickness"], 0.05)
    assert contacts["nodes"].shape == (len(contacts), 3)
    assert world.diagnose() == "" and world.device_error == ""
    world.await_device()
    assert world.report().startswith("Drape on host")
    world.remove_mesh(below)
    for _ in range(30):
        world.step(DT)
    assert world.positions(cloth)[:, 1].max() < -0.3


def test_recorded_impulses_carry_the_cloth(world, sheet, plate):
    cloth = world.add_cloth(*sheet[:2], mass=2)
    below = world.add_mesh(*plate[:2])
    for _ in range(90):
        world.step(DT)
    assert len(world.step_contacts()) == 0
    world.record_contacts()
    world.step(DT)
    contacts = world.step_contacts()
    assert set(contacts["cloth"]) == {cloth} and set(contacts["obstacle"]) == {below}
    assert set(contacts["other"]) == {-1} and contacts["triangle"].min() >= 0
    assert numpy.allclose(contacts["impulse"].sum(axis=0), (0, 2 * 9.81 / 60, 0), atol=0.01)


def test_pins_hold_follow_and_let_go(world, sheet):
    cloth = world.add_cloth(*sheet[:2], pins=numpy.array([0, 8], numpy.int32))
    positions = world.positions(cloth)
    for step in range(60):
        world.set_positions(cloth, [0, 8], [[-0.4, 0.3 + step / 60, -0.4], [0.4, 0.3 + step / 60, -0.4]])
        world.step(DT)
    assert numpy.allclose(positions[[0, 8], 1], 0.3 + 59 / 60)
    assert positions[:, 1].mean() > 0.4
    with pytest.raises(ValueError, match="^node 0 is pinned$"):
        world.set_velocities(cloth, [0], [[0, 1, 0]])
    world.set_pinned(cloth, [0, 8], False)
    world.set_velocities(cloth, [0], [[0, 1, 0]])
    assert world.velocities(cloth)[0].tolist() == [0, 1, 0]
    for _ in range(60):
        world.step(DT)
    assert positions[:, 1].max() < 0.3


@pytest.mark.parametrize("leaves_out", [False, True])
def test_triangles_that_are_left_out_let_cloth_through(world, sheet, plate, leaves_out):
    cloth, mesh = world.add_cloth(*sheet[:2]), world.add_mesh(*plate[:2])
    world.leave_out_triangles(mesh, numpy.arange(len(plate.triangles), dtype=numpy.int32))
    if not leaves_out:
        world.leave_out_triangles(mesh, [])
    for _ in range(60):
        world.step(DT)
    assert (world.positions(cloth)[:, 1].mean() < -1) == leaves_out
    with pytest.raises(ValueError, match="there is no triangle -1"):
        world.leave_out_triangles(mesh, [-1])


@pytest.mark.parametrize("how", ["pose", "vertices"])
def test_obstacles_carry_cloth(world, sheet, plate, how):
    cloth, lift = world.add_cloth(*sheet[:2]), world.add_mesh(*plate[:2])
    for _ in range(60):
        world.step(DT)
    for step in range(1, 21):
        if how == "pose":
            world.set_pose(lift, (0, step / 20, 0))
        else:
            world.set_vertices(lift, plate.positions + numpy.float32((0, step / 20, 0)))
        assert world.step(DT) == 0
    assert world.positions(cloth)[:, 1].min() > 1
    before = world.positions(cloth)[:, 1].mean()
    world.set_pose(lift, (0, -10, 0), teleport=True)
    world.step(DT)
    assert abs(world.positions(cloth)[:, 1].mean() - before) < 0.1


@pytest.mark.parametrize("apart", [True, False])
def test_layers_stay_apart_on_request(world, sheet, plate, apart):
    layers = [world.add_cloth(sheet.positions + numpy.float32((0, height, 0)), sheet.triangles, self_collision=apart)
              for height in (0, 0.1)]
    world.add_mesh(*plate[:2])
    for _ in range(120):
        world.step(DT)
    heights = [world.positions(layer)[:, 1].mean() for layer in layers]
    assert numpy.allclose(heights, (0.02, 0.04 if apart else 0.02), atol=0.004)
    assert len(world.cloth_triangles()) == 0
    assert (world.statistics["self_contacts"] > 0) == apart


def test_cloth_that_starts_intersecting_is_listed(world, sheet):
    upright = sheet.positions.copy()
    upright[:, 1] += upright[:, 0]
    upright[:, 0] = 0.013
    cloths = [world.add_cloth(positions, sheet.triangles, self_collision=True)
              for positions in (sheet.positions, upright)]
    assert world.step(DT) & drape.StepStatus.CLOTHS_MEET
    meeting = world.cloth_triangles()
    assert len(meeting) > 0 and set(meeting["cloths"].ravel()) == set(cloths)
    assert drape.status_text(world.statistics["status"]) != ""


def test_masses_rest_positions_and_ropes(world, sheet):
    world.set_gravity((0, 0, 0))
    cloth = world.add_cloth(*sheet[:2], rest_positions=sheet.positions * numpy.float32(0.5),
                            mass=numpy.full(81, 0.01, numpy.float32))
    for _ in range(120):
        world.step(DT)
    positions = world.positions(cloth)
    assert abs(numpy.linalg.norm(positions[1] - positions[0]) - 0.05) < 0.005
    world.set_gravity([0, -9.81, 0])
    rope = world.add_cloth([[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]], edges=[[0, 1], [1, 2]], pins=[0], damping=0.2)
    for _ in range(240):
        world.step(DT)
    assert abs(world.positions(rope)[2, 1] + 0.2) < 0.02


def test_threads_share_a_world_while_python_runs(world, sheet, plate):
    cloth = world.add_cloth(*sheet[:2])
    world.add_mesh(*plate[:2])
    steps, failures = [0] * 3, []

    def step(number):
        try:
            for _ in range(30):
                world.step(DT)
                steps[number] += 1
        except Exception as error:  # the test fails with it
            failures.append(error)

    threads = [threading.Thread(target=step, args=(number,)) for number in range(3)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        assert world.report() and world.statistics["calls_ms"] >= 0
        world.positions(cloth)
    for thread in threads:
        thread.join()
    assert not failures and steps == [30] * 3
    alone = drape.ClothWorld(drape.Settings(backend="host", threads=2))
    own = alone.add_cloth(*sheet[:2])
    alone.add_mesh(*plate[:2])
    for _ in range(90):
        alone.step(DT)
    assert numpy.array_equal(alone.positions(own), world.positions(cloth))


def test_worlds_of_several_threads_run_side_by_side(host, sheet, plate):
    found = []

    def drop():
        world = drape.ClothWorld(host)
        cloth = world.add_cloth(*sheet[:2])
        world.add_mesh(*plate[:2])
        for _ in range(40):
            world.step(DT)
        found.append(world.positions(cloth))

    threads = [threading.Thread(target=drop) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3 and all(numpy.array_equal(one, found[0]) for one in found)


def test_the_log_gets_problems_and_may_not_call_its_world(sheet, plate):
    lines, errors = [], []

    def log(line):
        lines.append(line)
        try:
            world.step(DT)
        except RuntimeError as error:
            errors.append(str(error))

    world = drape.ClothWorld(drape.Settings(backend="host", log=log))
    world.add_cloth(sheet.positions - numpy.float32((0, 0.3, 0)), sheet.triangles)
    upright = plate.positions[:, [1, 0, 2]] + numpy.float32((0.013, 0, 0))
    world.add_mesh(upright, plate.triangles)
    assert world.step(DT) & drape.StepStatus.STARTS_INTERSECTING
    assert len(lines) == 1 and lines[0].startswith("cloth 0 begins a step") and "obstacle 0 (" in lines[0]
    assert errors == ["the object is in use: its log must not call it"]


def test_an_exception_of_the_log_is_dropped(sheet, plate):
    program = """
import drape, numpy
def log(line): raise KeyError("from the log")
world = drape.ClothWorld(drape.Settings(backend="host", log=log))
world.add_cloth([[-1, 0, -1], [1, 0, -1], [0, 0, 1]], [[0, 1, 2]])
world.add_mesh([[0.01, -1, -3], [0.01, -1, 3], [0.01, 3, 0]], [[0, 1, 2]])
print(int(world.step()))
"""
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert int(result.stdout) & drape.StepStatus.STARTS_INTERSECTING
    assert "from the log" in result.stderr


@pytest.mark.parametrize("error, text, call", [
    (TypeError, "positions: float32 expected, not float64", lambda w, s: w.add_cloth(
        s.positions.astype(float), s.triangles)),
    (TypeError, "triangles: int32 expected, not int64", lambda w, s: w.add_cloth(s.positions, s.triangles.astype(int))),
    (ValueError, r"positions: shape \(n, 3\) expected, not \(81, 2\)", lambda w, s: w.add_cloth(
        s.positions[:, :2], s.triangles)),
    (ValueError, r"rest_positions: shape \(81, 3\) expected, not \(80, 3\)", lambda w, s: w.add_cloth(
        *s[:2], rest_positions=s.positions[1:])),
    (ValueError, r"mass: shape \(81,\) expected, not \(3,\)", lambda w, s: w.add_cloth(*s[:2], mass=[1, 2, 3])),
    (ValueError, "^mass should be above 0", lambda w, s: w.add_cloth(*s[:2], mass=0)),
    (ValueError, "^each mass should be above 0", lambda w, s: w.add_cloth(*s[:2], mass=[0] * 81)),
    (ValueError, "^friction should be 0 to 1", lambda w, s: w.add_cloth(*s[:2], friction=2)),
    (ValueError, "^pins: there is no node 81 among 81", lambda w, s: w.add_cloth(*s[:2], pins=[81])),
    (ValueError, "^a cloth has one vertex", lambda w, s: w.add_cloth(())),
    (TypeError, "thickness has the wrong type", lambda w, s: w.add_cloth(*s[:2], thickness="thick")),
    (ValueError, "triangle 0 has the index 71 among 5 vertices", lambda w, s: w.add_mesh(
        s.positions[:5], s.triangles[::-1])),
    (ValueError, "^an obstacle has one triangle", lambda w, s: w.add_mesh(s.positions, ())),
    (ValueError, "^vertices: value 0 is not finite", lambda w, s: w.add_mesh(s.positions * numpy.nan, s.triangles)),
    (ValueError, "rotation: 4 numbers expected, not 3", lambda w, s: w.add_mesh(*s[:2], rotation=(0, 0, 1))),
    (ValueError, "^there is no obstacle 3", lambda w, s: w.set_pose(3, (0, 0, 0))),
    (ValueError, "^there is no obstacle -1", lambda w, s: w.set_pose(-1, (0, 0, 0))),
    (ValueError, "^there is no cloth 0", lambda w, s: w.positions(0)),
    (ValueError, "^dt should be above 0", lambda w, s: w.step(0)),
    (ValueError, "gravity: 3 numbers expected", lambda w, s: w.set_gravity((0, -9.81))),
    (ValueError, "^gravity: value 1 is not finite", lambda w, s: w.set_gravity((0, float("nan"), 0))),
])
def test_bad_arguments_raise_and_change_nothing(world, sheet, error, text, call):
    with pytest.raises(error, match=text):
        call(world, sheet)
    assert world.add_cloth(*sheet[:2]) == 0 and world.add_mesh(*sheet[:2]) == 0
