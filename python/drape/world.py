"""A world of cloth and triangle meshes."""
from __future__ import annotations

from typing import Any, Dict, Optional, Sequence, Union, cast

import numpy

from . import _drape
from .arrays import Array, Floats, Indices, floats, indices, numbers
from .settings import Settings, StepStatus, binding_of


class ClothWorld:
    """Cloths that fall, hang and are carried, and obstacles that move as they are told.

    Cloths and obstacles have indices from 0 on, in the order in which they were added; an index is never used again.
    Methods raise ValueError for an unknown index or a value out of range, and change nothing then.
    """

    def __init__(self, settings: Optional[Settings] = None, gravity: Sequence[float] = (0.0, -9.81, 0.0)) -> None:
        """Chooses the device and compiles its kernels: milliseconds to seconds. gravity: m/s².

        Raises ValueError if a setting is out of range, and DeviceError if the requested device is missing.
        """
        self._own = _drape.World(binding_of(settings))
        self.set_gravity(gravity)

    def set_gravity(self, gravity: Sequence[float]) -> None:
        """Sets the acceleration of all cloth, m/s²."""
        self._own.set_gravity(numbers(gravity, 3, "gravity"))

    def add_cloth(self, positions: Floats, triangles: Indices = (), *, edges: Indices = (),
                  rest_positions: Optional[Floats] = None, pins: Indices = (), mass: Union[float, Floats] = 1.0,
                  thickness: float = 0.02, stiffness: float = 1.0, bending_stiffness: float = 0.02,
                  friction: float = 0.5, damping: float = 0.05, iterations: int = 5,
                  self_collision: bool = False) -> int:
        """Adds a cloth and returns its index. Every edge of a triangle is a link, and so is each of `edges`.

        positions: float32 (n, 3), the nodes, m. triangles: int32 (m, 3). edges: int32 (k, 2), edges that belong to no
        triangle, such as those of a rope. rest_positions: float32 (n, 3), give links their lengths; positions by
        default. pins: int32 (p,), nodes that the solver does not move. mass: of the whole cloth, kg, or float32 (n,),
        of each node; above 0. thickness: m, above 0; layers rest on each other at this distance, and above an obstacle
        at half of it and the obstacle's margin. stiffness: of links, above 0 up to 1. bending_stiffness: 0 to 1, 0 for
        none. friction: 0 to 1, multiplied with the obstacle's. damping: share of the velocity that a step takes away,
        0 to 1. iterations: substeps in a step, 1 to 1000; more of them stretch less. self_collision: the cloth
        collides with itself and with other cloth that has this.
        """
        nodes = floats(positions, (None, 3), "positions")
        rest = nodes if rest_positions is None else floats(rest_positions, nodes.shape, "rest_positions")
        single = numpy.ndim(mass) == 0
        masses = floats((), (0,), "mass") if single else floats(cast(Floats, mass), (len(nodes),), "mass")
        options = dict(mass=mass if single else 1.0, thickness=thickness, stiffness=stiffness,
                       bending_stiffness=bending_stiffness, friction=friction, damping=damping, iterations=iterations,
                       self_collision=self_collision)
        return self._own.add_cloth(nodes, indices(triangles, (None, 3), "triangles"),
                                   indices(edges, (None, 2), "edges"), rest, indices(pins, (None,), "pins"), masses,
                                   options)

    def add_mesh(self, vertices: Floats, triangles: Indices, *, margin: float = 0.01, friction: float = 1.0,
                 one_sided: bool = False, position: Sequence[float] = (0.0, 0.0, 0.0),
                 rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0)) -> int:
        """Adds an obstacle and returns its index. It stays where it is until set_pose() or set_vertices() moves it.

        vertices: float32 (n, 3), in the obstacle's own frame, m. triangles: int32 (m, 3), one at least. margin:
        distance from the surface, m, 0 or more; see add_cloth(). friction: 0 or more, multiplied with the cloth's.
        one_sided: only the front is solid, from which triangles run counter-clockwise. position: of the frame, m.
        rotation: of the frame, a quaternion x y z w.
        """
        options = dict(margin=margin, friction=friction, one_sided=one_sided)
        return self._own.add_obstacle(floats(vertices, (None, 3), "vertices"),
                                      indices(triangles, (None, 3), "triangles"), options,
                                      numbers(position, 3, "position"), numbers(rotation, 4, "rotation"))

    def remove_cloth(self, cloth: int) -> None:
        """Removes a cloth. Views of its nodes stay valid."""
        self._own.remove_cloth(cloth)

    def remove_mesh(self, mesh: int) -> None:
        """Removes an obstacle."""
        self._own.remove_obstacle(mesh)

    def set_pose(self, mesh: int, position: Sequence[float], rotation: Sequence[float] = (0.0, 0.0, 0.0, 1.0), *,
                 teleport: bool = False) -> None:
        """Moves an obstacle to a pose, which it reaches at the end of the next step.

        position: m. rotation: a quaternion x y z w of any length but 0. teleport: the obstacle is there at once, and
        sweeps no path.
        """
        self._own.set_pose(mesh, numbers(position, 3, "position"), numbers(rotation, 4, "rotation"), teleport)

    def set_vertices(self, mesh: int, vertices: Floats, *, teleport: bool = False) -> None:
        """Moves an obstacle's vertices, which reach these positions at the end of the next step.

        vertices: float32 (n, 3), in the obstacle's own frame, m. teleport: as in set_pose().
        """
        self._own.set_vertices(mesh, floats(vertices, (None, 3), "vertices"), teleport)

    def leave_out_triangles(self, mesh: int, triangles: Indices) -> None:
        """Leaves these triangles of an obstacle out of collision, and no others: doors and holes.

        triangles: int32 (n,), their indices in add_mesh(). An empty sequence brings all of them back.
        """
        self._own.leave_out_triangles(mesh, indices(triangles, (None,), "triangles"))

    def set_pinned(self, cloth: int, nodes: Indices, pinned: bool = True) -> None:
        """Pins nodes, or lets them go with the masses that they had.

        nodes: int32 (n,). A pinned node stays where it is, or goes where set_positions() puts it.
        """
        self._own.set_pinned(cloth, indices(nodes, (None,), "nodes"), pinned)

    def set_positions(self, cloth: int, nodes: Indices, positions: Floats, *, teleport: bool = False) -> None:
        """Moves nodes at once. Pinned nodes take the cloth along in the next step.

        nodes: int32 (n,). positions: float32 (n, 3), m. teleport: for cloth that is put elsewhere; Drape then pushes
        apart what intersects there.
        """
        chosen = indices(nodes, (None,), "nodes")
        self._own.set_positions(cloth, chosen, floats(positions, (len(chosen), 3), "positions"), teleport)

    def set_velocities(self, cloth: int, nodes: Indices, velocities: Floats) -> None:
        """Sets velocities of nodes. nodes: int32 (n,), none of them pinned. velocities: float32 (n, 3), m/s."""
        chosen = indices(nodes, (None,), "nodes")
        self._own.set_velocities(cloth, chosen, floats(velocities, (len(chosen), 3), "velocities"))

    def step(self, dt: float = 1.0 / 60) -> StepStatus:
        """Runs one step of `dt` seconds, above 0, and returns what it left out; 0 for a good step.

        Other Python threads run meanwhile. Views of nodes change during a step.
        """
        return StepStatus(self._own.step(dt))

    def positions(self, cloth: int) -> Array:
        """Returns the nodes' positions, m: (n, 3), a read-only view of Bullet's own nodes.

        Nothing is copied: steps change the view. Take copy() of it to keep a moment. It is float32, or float64 where
        Bullet is built in double precision, and stays valid after the cloth is removed and the world is gone.
        """
        return self._own.nodes(cloth)[0]

    def velocities(self, cloth: int) -> Array:
        """Returns the nodes' velocities, m/s: (n, 3), a view like positions()."""
        return self._own.nodes(cloth)[1]

    def normals(self, cloth: int) -> Array:
        """Returns the nodes' unit normals: (n, 3), a view like positions()."""
        return self._own.nodes(cloth)[2]

    def contacts(self) -> Array:
        """Returns the contacts of the last step between cloth and obstacles, as records.

        cloth, obstacle: their indices.
        nodes (3): nodes of the cloth's feature, -1 if unused.
        weights (3): weights of these nodes, with the sum 1.
        normal (3): unit vector from the obstacle to the cloth.
        point (3): point on the obstacle, m.
        gap: distance at the step's predicted end, thickness subtracted, m.
        thickness: distance at which the two rest, m.
        """
        return self._own.contacts()

    def record_contacts(self, record: bool = True) -> None:
        """Makes the coming steps keep contacts with their impulses for step_contacts(), or not.

        Results do not change. The host solves all cloth meanwhile.
        """
        self._own.record_contacts(bool(record))

    def step_contacts(self) -> Array:
        """Returns the contacts of the last step with what they did, as records; empty unless they were recorded.

        cloth, obstacle, other: the cloth, and the obstacle or the other cloth beside it; the missing one is -1.
        triangle: a triangle of the obstacle that has the contact's feature, -1 beside cloth.
        nodes, weights, other_nodes, other_weights (3): the features of the cloth and of the other cloth.
        normal (3): unit vector from the obstacle or the other cloth to the cloth.
        point (3): point on the obstacle or the other cloth, m.
        impulse (3): given to the cloth in the step, friction included, N s.
        gap: distance where the step ended, thickness subtracted, m.
        thickness: distance at which the two rest, m.
        time_of_impact: share of the step, below 1 if the cloth's path met the surface.
        """
        return self._own.step_contacts()

    def cloth_triangles(self) -> Array:
        """Returns triangles of cloth with self collision that intersected where the last step began, as records.

        cloths (2): the cloth of each triangle.
        nodes (2, 3): the nodes of each triangle.
        """
        return self._own.cloth_triangles()

    @property
    def statistics(self) -> Dict[str, Any]:
        """Work and cost of the last step: the fields of StepStatistics (drape/report.h), such as contacts, solve_ms.

        Times are milliseconds. calls_ms is all of the soft-body solver's time, collision_ms Drape's share.
        """
        return self._own.statistics()

    @property
    def device(self) -> Dict[str, Any]:
        """The device in use and the reason for it, with the fields of DeviceReport (drape/report.h)."""
        return self._own.device()

    @property
    def device_error(self) -> str:
        """Why the host took over from a device; "" if it did not."""
        return self._own.device_error()

    def await_device(self) -> None:
        """Waits until the start of a device in the background has ended, if there is one."""
        self._own.await_device()

    def report(self) -> str:
        """Returns one line with the device, the reason for it, and the last step."""
        return self._own.report()

    def diagnose(self) -> str:
        """Returns problems of the world, one line each; "" if there are none. Takes milliseconds to seconds."""
        return self._own.diagnose()
