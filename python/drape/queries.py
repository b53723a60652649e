"""Collision queries without a world: moving features, triangles, and whole meshes."""
from __future__ import annotations

import dataclasses
import enum
from typing import Any, Dict, NamedTuple, Optional, Tuple, Union, cast

import numpy

from . import _drape
from .arrays import Array, Floats, Indices, floats, indices
from .settings import Settings, binding_of

#: Kind of a pair of features: a vertex and a face.
VERTEX_FACE = 0
#: Kind of a pair of features: two edges.
EDGES = 1


def _default(name: str) -> Any:
    """Returns the field of CcdSettings whose default is that of C++."""
    return dataclasses.field(default_factory=lambda: _drape.default_ccd_settings()[name])


@dataclasses.dataclass
class CcdSettings:
    """Parameters of the search for the time at which moving features touch.

    separation: distance at which features count as touching, m, 0 or more.
    tolerance: variation of the features' offset below which they count as touching, relative to the pair's extent.
    time_tolerance: resolution of the time of impact, as a fraction of the step.
    box_limit: number of boxes after which the search ends with the safe answer, a hit.
    """
    separation: float = _default("separation")
    tolerance: float = _default("tolerance")
    time_tolerance: float = _default("time_tolerance")
    box_limit: int = _default("box_limit")


class Mesh(NamedTuple):
    """A triangle mesh of a query."""
    positions: Floats  #: float32 (n, 3), m
    triangles: Indices  #: int32 (n, 3), vertex indices
    edges: Indices = ()  #: int32 (n, 2), edges that belong to no triangle


class QueryLimits(enum.IntFlag):
    """Says what a result lacks: CANDIDATES, no pair was tested, or ANSWERS, answers are counted but not listed."""
    WHOLE = 0
    CANDIDATES = 1
    ANSWERS = 2


class Motions(NamedTuple):
    """Answers of Queries.motions(), one per question."""
    hit: Array  #: bool (n,), False if the features are proved apart
    time: Array  #: float32 (n,), fraction of the step, never later than the true time; 1 without a hit
    u: Array  #: float32 (n,), weight of the face's second corner, or of the first edge's second end
    v: Array  #: float32 (n,), weight of the face's third corner, or of the second edge's second end
    boxes: Array  #: uint32 (n,), number of boxes that the search examined


class MeshPairs(NamedTuple):
    """Answers of Queries.mesh_pairs(). Read limits before the lists."""
    limits: QueryLimits  #: what the result lacks
    candidates: int  #: number of pairs whose volumes overlap
    within_count: int  #: number of pairs within the radius
    intersecting_count: int  #: number of pairs that intersect
    within: Array  #: uint32 (n, 2), triangles within the radius, sorted
    intersecting: Array  #: uint32 (n, 2), triangles that intersect, sorted


class MeshMotion(NamedTuple):
    """Answers of Queries.mesh_motion(). Read limits before the list."""
    limits: QueryLimits  #: what the result lacks
    triangle_pairs: int  #: number of pairs of triangles whose volumes overlap
    vertex_face_candidates: int  #: number of vertex-face pairs whose volumes over the step overlap
    edge_candidates: int  #: number of edge-edge pairs whose volumes over the step overlap
    vertex_face_hits: int  #: number of vertex-face pairs that touch
    edge_hits: int  #: number of edge-edge pairs that touch
    touching: Array  #: records with the fields kind, vertices (4) and time (a fraction of the step)


def _mesh(mesh: Mesh, name: str) -> Tuple[Array, Array, Array]:
    """Returns the arrays of a mesh or of a tuple like it, checked."""
    positions, triangles, edges = Mesh(*mesh)
    return (floats(positions, (None, 3), f"{name}.positions"), indices(triangles, (None, 3), f"{name}.triangles"),
            indices(edges, (None, 2), f"{name}.edges"))


class Queries:
    """Answers collision queries on one back end.

    Guarantee: no true pair is denied, and every back end gives the same answers, bit for bit. Every call uploads,
    computes and waits: ask many questions at once.
    """

    def __init__(self, settings: Optional[Settings] = None) -> None:
        """Chooses the device and compiles its kernels.

        Raises ValueError if a setting is out of range, and DeviceError if the requested device is missing.
        """
        self._own = _drape.Queries(binding_of(settings))

    @property
    def device(self) -> Dict[str, Any]:
        """The device in use and the reason for it, with the fields of DeviceReport (drape/report.h)."""
        return self._own.device()

    @property
    def device_error(self) -> str:
        """The last failure: why the host took over from a device, or why a call failed. "" if there was none."""
        return self._own.host_reason()

    def motions(self, start: Floats, end: Floats, kind: Union[int, Indices] = VERTEX_FACE,
                settings: Optional[CcdSettings] = None) -> Motions:
        """Asks if pairs of moving features touch, and when.

        start, end: float32 (n, 4, 3), the four vertices at the step's start and end, m: a vertex and the corners of a
        face, or edge by edge. kind: VERTEX_FACE or EDGES, for all or for each. Raises ValueError for another kind, or
        a tolerance that is negative or not finite.
        """
        first = floats(start, (None, 4, 3), "start")
        questions = numpy.zeros(len(first), _drape.MOTION_QUERY)
        questions["start"] = first.reshape(-1, 12)
        questions["end"] = floats(end, first.shape, "end").reshape(-1, 12)
        one = numpy.ndim(kind) == 0
        kinds = indices([kind] if one else cast(Indices, kind), (1 if one else len(first),), "kind")
        if numpy.any((kinds < VERTEX_FACE) | (kinds > EDGES)):
            raise ValueError("kind: VERTEX_FACE or EDGES expected")
        questions["kind"] = kinds
        found = self._own.motions(questions, dataclasses.asdict(settings or CcdSettings()))
        return Motions(found["hit"] != 0, found["time"], found["u"], found["v"], found["boxes"])

    def triangles(self, a: Floats, b: Floats, exact: bool = True) -> Array:
        """Tests pairs of triangles and returns bool (n,), True for a pair that intersects.

        a, b: float32 (n, 3, 3), the corners, m. exact: False reports a few pairs that nearly touch, too, and is faster.
        """
        first = floats(a, (None, 3, 3), "a")
        questions = numpy.zeros(len(first), _drape.TRIANGLE_QUERY)
        questions["a"] = first.reshape(-1, 9)
        questions["b"] = floats(b, first.shape, "b").reshape(-1, 9)
        return self._own.triangles(questions, exact) != 0

    def mesh_pairs(self, a: Mesh, b: Optional[Mesh] = None, radius: float = 0.0) -> MeshPairs:
        """Finds triangles of two meshes within the radius (m, 0 or more), and those that intersect.

        Without `b` the triangles of `a` are paired with each other, but for those that share a vertex. Edges of a mesh
        count as triangles without area, numbered behind the triangles. Raises ValueError for an index out of range.
        """
        other = Mesh((), ()) if b is None else b
        found = self._own.mesh_pairs(*_mesh(a, "a"), b is not None, *_mesh(other, "b"), radius)
        return MeshPairs(QueryLimits(found[0]), *found[1:])

    def mesh_motion(self, mesh: Mesh, end: Floats, settings: Optional[CcdSettings] = None) -> MeshMotion:
        """Finds features of a mesh that touch one another while its vertices move in straight lines to `end`.

        end: float32 (n, 3), m. Raises ValueError for an index out of range.
        """
        own = _mesh(mesh, "mesh")
        to = floats(end, own[0].shape, "end")
        found = self._own.mesh_motion(*own, to, dataclasses.asdict(settings or CcdSettings()))
        return MeshMotion(QueryLimits(found[0]), *found[1:])
