"""Queries: the bits of the C++ interface, and errors that name the argument."""
import threading
import time

import numpy
import pytest

import drape


@pytest.fixture(scope="module")
def queries(host):
    return drape.Queries(host)


def test_mesh_pairs_are_those_of_cpp(queries, reference):
    soup, other = reference.mesh("soup"), reference.mesh("other")
    found = queries.mesh_pairs(soup, other, radius=0.02)
    counts = reference.array("counts", numpy.uint64, -1)
    assert found.limits == drape.QueryLimits.WHOLE
    assert (found.candidates, found.within_count, found.intersecting_count) == tuple(counts[:3])
    assert len(found.within) > len(found.intersecting) > 0
    assert numpy.array_equal(found.within, reference.array("within", numpy.uint32, -1, 2))
    assert numpy.array_equal(found.intersecting, reference.array("intersecting", numpy.uint32, -1, 2))
    own = queries.mesh_pairs(soup, radius=0.01)
    assert numpy.array_equal(own.within, reference.array("own", numpy.uint32, -1, 2))


def test_mesh_motion_is_that_of_cpp(queries, reference):
    end = reference.array("end", numpy.float32, -1, 3)
    found = queries.mesh_motion(reference.mesh("soup"), end)
    counts = reference.array("counts", numpy.uint64, -1)[3:]
    assert found[1:6] == tuple(counts)
    assert len(found.touching) > 0
    assert found.touching.tobytes() == (reference.folder / "touching").read_bytes()
    assert set(found.touching["kind"]) == {drape.VERTEX_FACE, drape.EDGES}


def test_motions_are_those_of_cpp(queries, reference):
    questions = reference.array("questions", [("start", "f4", (4, 3)), ("end", "f4", (4, 3)), ("kind", "u4")], -1)
    found = queries.motions(questions["start"], questions["end"], questions["kind"].astype(numpy.int32))
    results = reference.array("results", [("hit", "u4"), ("time", "f4"), ("u", "f4"), ("v", "f4"), ("boxes", "u4")], -1)
    for field in results.dtype.names:
        assert numpy.array_equal(getattr(found, field), results[field]), field
    assert found.hit.dtype == bool and 0 < found.hit.sum() < len(results)
    faces = questions[::2]
    assert numpy.array_equal(queries.motions(faces["start"], faces["end"]).time, results["time"][::2])


def test_triangles_are_those_of_cpp(queries, reference):
    pairs = reference.array("triangles", numpy.float32, -1, 2, 3, 3)
    meet = queries.triangles(pairs[:, 0], pairs[:, 1])
    assert meet.dtype == bool and 0 < meet.sum() < len(meet)
    assert numpy.array_equal(meet, reference.array("meet", numpy.uint32, -1))
    assert numpy.all(queries.triangles(pairs[:, 0], pairs[:, 1], exact=False) >= meet)


def test_edges_count_as_triangles(queries):
    rope = drape.Mesh([[0.2, -1, 0.2], [0.2, 1, 0.2]], (), [[0, 1]])
    found = queries.mesh_pairs(drape.Mesh([[0, 0, 0], [0, 0, 1], [1, 0, 0]], [[0, 1, 2]]), rope)
    assert found.intersecting.tolist() == [[0, 0]]


def test_limits_leave_out_lists(host, reference):
    few = drape.Queries(drape.Settings(backend="host", contact_limit=3))
    found = few.mesh_pairs(reference.mesh("soup"), reference.mesh("other"), 0.02)
    assert found.limits == drape.QueryLimits.ANSWERS and found.within_count > 3
    none = drape.Queries(drape.Settings(backend="host", candidate_limit=3))
    assert none.mesh_pairs(reference.mesh("soup")).limits == drape.QueryLimits.CANDIDATES


def test_lists_of_numbers_and_no_questions_are_accepted(queries):
    one, other = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0], [0, 0, 1]]
    assert queries.triangles([one], (other,)).tolist() == [True]
    assert len(queries.triangles((), ())) == 0
    assert len(queries.motions((), ()).hit) == 0
    assert queries.mesh_pairs(drape.Mesh((), ())).candidates == 0


@pytest.mark.parametrize("error, text, call", [
    (TypeError, "a: float32 expected, not float64; convert with astype", lambda q: q.triangles(
        numpy.zeros((1, 3, 3)), numpy.zeros((1, 3, 3)))),
    (ValueError, r"a: shape \(n, 3, 3\) expected, not \(3, 3\)", lambda q: q.triangles(
        numpy.zeros((3, 3), numpy.float32), ())),
    (ValueError, r"b: shape \(2, 3, 3\) expected, not \(1, 3, 3\)", lambda q: q.triangles(
        numpy.zeros((2, 3, 3), numpy.float32), numpy.zeros((1, 3, 3), numpy.float32))),
    (TypeError, "a.triangles: int32 expected, not int64", lambda q: q.mesh_pairs(
        drape.Mesh(numpy.zeros((3, 3), numpy.float32), numpy.array([[0, 1, 2]])))),
    (TypeError, "a.triangles: int32 expected, not float64", lambda q: q.mesh_pairs(
        drape.Mesh([[0, 0, 0]], [[0.5, 1, 2]]))),
    (ValueError, "^a mesh with an index out of range\ntriangle 0 has the index 7", lambda q: q.mesh_pairs(
        drape.Mesh([[0, 0, 0]], [[0, 0, 7]]))),
    (ValueError, "index is beyond int32", lambda q: q.mesh_pairs(drape.Mesh([[0, 0, 0]], [[0, 0, 2**40]]))),
    (ValueError, "^a radius", lambda q: q.mesh_pairs(drape.Mesh((), ()), radius=-1)),
    (ValueError, "kind: VERTEX_FACE or EDGES", lambda q: q.motions(numpy.zeros((1, 4, 3), numpy.float32),
                                                                   numpy.zeros((1, 4, 3), numpy.float32), 2)),
    (ValueError, "^CcdSettings", lambda q: q.motions((), (), settings=drape.CcdSettings(tolerance=-1))),
    (ValueError, "rows of different lengths", lambda q: q.mesh_pairs(drape.Mesh([[0, 0], [1, 2, 3]], ()))),
    (ValueError, r"end: shape \(1, 3\) expected", lambda q: q.mesh_motion(drape.Mesh([[0, 0, 0]], ()), ())),
])
def test_bad_arguments_raise(queries, error, text, call):
    with pytest.raises(error, match=text):
        call(queries)


def test_arrays_in_any_layout_are_accepted(queries, reference):
    soup, other = reference.mesh("soup"), reference.mesh("other")
    wide = numpy.zeros((len(soup.positions), 7), numpy.float32)
    wide[:, 2:5] = soup.positions
    found = queries.mesh_pairs(drape.Mesh(wide[:, 2:5], numpy.asfortranarray(soup.triangles)), other, 0.02)
    assert numpy.array_equal(found.within, queries.mesh_pairs(soup, other, 0.02).within)


def test_threads_share_queries(queries, reference):
    soup = reference.mesh("soup")
    expected = queries.mesh_pairs(soup, radius=0.01).within
    same = []

    def ask():
        same.extend(numpy.array_equal(queries.mesh_pairs(soup, radius=0.01).within, expected) for _ in range(10))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same == [True] * 40


def test_other_threads_run_during_a_query(queries, make_sheet):
    mesh = make_sheet(60, 1, 0)
    called = []

    def ask():
        called.append(time.perf_counter())
        queries.mesh_pairs(mesh, radius=0.05)
        called.append(time.perf_counter())

    thread = threading.Thread(target=ask)
    ticks = []
    thread.start()
    while thread.is_alive():
        ticks.append(time.perf_counter())
        time.sleep(0.001)
    thread.join()
    assert sum(called[0] < tick < called[1] for tick in ticks) > 3
