"""Geometric queries of a world in its present state: rays, nearest points, overlaps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from itertools import chain, islice
from struct import Struct
from typing import TYPE_CHECKING, Any, Concatenate, NoReturn, ParamSpec, Protocol, TypeVar
from weakref import ref

import numpy as np

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds, turned_box
from carom.description.transform import rotation_matrix
from carom.engine.contact_arrays import ContactArrays
from carom.engine.presence import absent_links
from carom.engine.queries.contact_search import NO_CONTACTS, ContactColumns, ContactSearch
from carom.engine.queries.nearest_pair import Nearest, NearestSearch
from carom.engine.queries.pair_search import NearestPoints, PairSearch
from carom.engine.queries.present_poses import PresentPoses
from carom.engine.queries.quick_queries import tell_placement
from carom.engine.queries.ray_cast import Points, RayCast, RayHit, RayTuple
from carom.engine.quick_scene import QuickScene
from carom.engine.row_maps import row_map_struct
from carom.layouts.codes import PLANE
from carom.layouts.contacts import IN_HIERARCHY, OVERLAPS, PLACED, READINESS, THERE
from carom.layouts.magnitudes import MAX_DISTANCE
from carom.layouts.queries import NearestPair
from carom.native.kernels import (
    link_poses_kernel,
    nearest_pair_kernel,
    place_shapes_kernel,
    prepare_rays_kernel,
)
from carom.native.launch import KernelStructs, Launch
from carom.native.made_once import made_once
from carom.native.tables import NUMPY_REAL, ArrayTable

if TYPE_CHECKING:
    from carom.engine.queries.soft_bodies import SoftQueries
    from carom.model.builder import WorldArrays

_POSE = Struct(f"7{np.dtype(NUMPY_REAL).char}")
P = ParamSpec("P")
Answer = TypeVar("Answer")

# Value of `placement.changes` if no shapes have been placed.
NEVER = -1


def _alone(
    ask: Callable[Concatenate[Queries, P], Answer],
) -> Callable[Concatenate[Queries, P], Answer]:
    @wraps(ask)
    def call(self: Queries, *arguments: P.args, **keywords: P.kwargs) -> Answer:
        with self._lock:
            return ask(self._current(), *arguments, **keywords)

    return call


class HasQueries(Protocol):
    """A world."""

    def queries(self) -> Queries:
        """Its present queries."""
        ...


class Queries:
    """The collision queries of a world, as launches over its present arrays.

    A method has the world for itself, and asks it as it is then. `ray_tuples`,
    `ray_tuple` and `contact_columns` are for callers that have the lock.

    `structs` are by the names of kernel arguments, `places` are body and link of each row of the link arrays,
    `pairs` is the workspace of collision detection, and `quick` gets addresses for quick calls.
    """

    def __init__(
        self,
        lock: Any,
        world: ref[HasQueries],
        structs: KernelStructs,
        positions: memoryview[float],
        places: Sequence[tuple[int, int]],
        contact_arrays: ContactArrays,
        pairs: ArrayTable,
        arrays: WorldArrays,
        soft_work: ArrayTable,
        quick: QuickScene,
    ) -> None:
        self._lock, self._world = lock, world
        self._structs = structs
        structs["places"] = row_map_struct(places)
        self._link_count = len(places)
        self._arrays = arrays
        self._touch = contact_arrays
        self._soft: SoftQueries | None = None
        if contact_arrays.soft.bodies:
            from carom.engine.queries.soft_bodies import SoftQueries

            self._soft = SoftQueries(
                structs, contact_arrays, arrays.state, soft_work, places, self._present_poses
            )
        # Quick calls do not handle soft bodies. In worlds with soft bodies, `quick` stays without addresses.
        self._quick = quick if self._soft is None else QuickScene()
        self._positions = positions
        self._all_shapes = contact_arrays.shapes
        self._shape_count = contact_arrays.shapes.shape_count
        self._shapes = contact_arrays.shapes.table.numpy
        self._pair_table = pairs
        self._pairs = pairs.numpy
        self._counts = memoryview(pairs.numpy["count_pairs"][0])
        self._contact_counts = memoryview(contact_arrays.contacts.numpy["count_contacts"][0])
        # The coordinates for which the shapes were last placed; quick calls write it, too.
        self._placed_at = bytearray(positions.nbytes)
        self._placement = self._quick.record.placement
        self._placement.changes = NEVER
        self._has_asked = False

    def _current(self) -> Queries:
        """Those of the world as it is now; without the world nothing changes any more."""
        world = self._world()
        return self if world is None else world.queries()

    @made_once
    def _present_poses(self) -> PresentPoses:
        return PresentPoses(self._arrays.state.bytes_of("link_pose"), self._structs)

    @made_once
    def _make_ready(self) -> dict[int, Launch]:
        return {
            PLACED: self._structs.launch(place_shapes_kernel),
            IN_HIERARCHY: self._structs.launch(prepare_rays_kernel, first_world=0),
        }

    @made_once
    def _cast(self) -> RayCast:
        return RayCast(self._structs)

    @made_once
    def _search(self) -> PairSearch:
        return PairSearch(self._structs, self._touch, self._quick)

    @made_once
    def _nearest_search(self) -> NearestSearch:
        return NearestSearch(ArrayTable(NearestPair), 1)

    @made_once
    def _contacts(self) -> ContactSearch:
        return ContactSearch(self._structs, self._touch.contacts, self._quick)

    @made_once
    def _extents(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Minimum and maximum corner of each shape, whether it is unbounded (a plane), and its link row."""
        rows = slice(self._shape_count)
        lowest, highest = (self._pairs[name][0, rows] for name in ("shape_lower", "shape_upper"))
        endless = (self._shapes["shape_kind"][rows] == PLANE) & (lowest[:, 0] <= highest[:, 0])
        return lowest, highest, endless, self._shapes["shape_link"][rows]

    @made_once
    def _without_shapes(self) -> list[tuple[int, Bounds]]:
        """Rows of links without shapes of rigid bodies, and their bounds in the link frame."""
        counts = self._shapes["link_shape_count"][: self._link_count].tolist()
        hidden = {body.rows.first["link"] for body in self._touch.soft.bodies}
        absent = absent_links(self._arrays, np.arange(self._link_count), np.zeros(1, dtype=np.int64))
        if absent is not None:
            hidden.update(np.flatnonzero(absent[0]).tolist())
        return [
            (row, self._all_shapes.bounds(row))
            for row, count in enumerate(counts)
            if not count and row not in hidden
        ]

    @_alone
    def cast_rays(
        self, starts: Points, ends: Points, *, mask: int = -1, hit_number: int = 0, separation: float = 0.0
    ) -> tuple[RayHit, ...]:
        """Cast rays.

        Args:
            starts: Starting points in world axes [m], shape (n, 3).
            ends: End points in world axes [m], shape (n, 3).
            mask: Mask of the collision groups that are hit.
            hit_number: 0 for the first hit of each ray, 1 for the second, and so on.
            separation: After a hit, hits on the same link within this fraction of the ray are ignored.

        Returns:
            The result of each ray.
        """
        hits = self.ray_tuples(starts, ends, mask=mask, hit_number=hit_number, separation=separation)
        return tuple(map(RayHit._make, hits))

    @_alone
    def cast_ray(
        self, start: Vector3, end: Vector3, *, mask: int = -1, hit_number: int = 0, separation: float = 0.0
    ) -> RayHit:
        """Cast one ray; the arguments are those of `cast_rays`."""
        return RayHit(*self.ray_tuple(start, end, mask=mask, hit_number=hit_number, separation=separation))

    def ray_tuples(
        self, starts: Points, ends: Points, *, mask: int = -1, hit_number: int = 0, separation: float = 0.0
    ) -> tuple[RayTuple, ...]:
        """As `cast_rays`, with plain tuples."""
        self._prepare(IN_HIERARCHY)
        soft = self._soft
        if soft is None:
            return self._cast(starts, ends, mask, hit_number, separation)
        from carom.engine.queries.soft_bodies import nth_hit

        # The n-th hit of all is one of the first n hits on shapes or one of the hits on soft bodies.
        rigid = [self._cast(starts, ends, mask, number, separation) for number in range(hit_number + 1)]
        on_soft = soft.cast(starts, ends, mask)
        return tuple(
            nth_hit([hits[ray] for hits in rigid], on_soft[ray], hit_number, separation)
            for ray in range(len(starts))
        )

    def ray_tuple(
        self, start: Vector3, end: Vector3, *, mask: int = -1, hit_number: int = 0, separation: float = 0.0
    ) -> RayTuple:
        """As `cast_ray`, with a plain tuple."""
        if self._soft is not None:
            hits = self.ray_tuples((start,), (end,), mask=mask, hit_number=hit_number, separation=separation)
            return hits[0]
        self._prepare(IN_HIERARCHY)
        return self._cast.one(start, end, mask, hit_number, separation)

    @_alone
    def nearest(
        self, first: Sequence[int], second: Sequence[int], max_distance: float
    ) -> list[NearestPoints]:
        """The nearest points between the shapes of two sets of links, up to `max_distance` apart.

        Args:
            first: Rows of links in the world's arrays, as a range or tuple.
            second: Rows of the other links.
            max_distance: Largest distance [m].

        Returns:
            The points, in the order of `first`, then of `second`, then of the shapes of each.
        """
        pairs = self._search.shape_pairs(first, second)
        if not pairs.links:
            return []
        self._prepare(PLACED)
        return self._search(pairs, min(max_distance, MAX_DISTANCE))

    @_alone
    def nearest_shapes(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """The nearest points of all pairs of two sets of shapes, by row, up to `max_distance` [m] apart."""
        self._prepare(PLACED)
        search = self._nearest_search
        search.ask(first, second, min(max_distance, MAX_DISTANCE))
        self._structs["nearest_pair"] = search.table.struct()
        self._structs.launch(nearest_pair_kernel, first_world=0).function()
        return search.answer()

    @property
    def contacts(self) -> NoReturn:
        """Contacts are a world's: `World.contacts`."""
        raise AttributeError("contacts are a world's: world.contacts(), or world.contacts(a, b)")

    def contact_columns(
        self, body_a: int, link_a: int, body_b: int, link_b: int, time_step: float
    ) -> ContactColumns:
        """The contacts between two bodies or links, as the last step or collision detection left them.

        Args:
            body_a: Number of a body, which is then the first body of each contact; negative for any.
            link_a: Its link, -1 for the base, -2 and less for any.
            body_b: Number of the second body; negative for any.
            link_b: Its link.
            time_step: Duration of a step [s], to convert impulses to forces.

        Returns:
            The contacts, to be read before the next query.
        """
        count, overlaps = self._contact_counts[THERE], self._contact_counts[OVERLAPS]
        asked = body_a, link_a, body_b, link_b, time_step
        rigid = self._contacts(count, overlaps, *asked) if count else NO_CONTACTS
        if self._soft is None:
            return rigid
        soft = self.soft_contacts(body_a, link_a, body_b, link_b, time_step)
        return _one_after_the_other(rigid, soft)

    def soft_contacts(
        self, body_a: int, link_a: int, body_b: int, link_b: int, time_step: float
    ) -> ContactColumns:
        """Those of `contacts` in which one of the bodies is soft."""
        if self._soft is None:
            return NO_CONTACTS
        return self._soft.contacts(body_a, link_a, body_b, link_b, time_step)

    @_alone
    def overlapping(self, lower: Vector3, upper: Vector3) -> list[int]:
        """Rows of the links whose bounds overlap a box, given by its corners in world axes [m].

        Bounds of links without shapes are nearly a point.
        """
        found: set[int] = set()
        if self._shape_count:
            self._prepare(PLACED)
            lowest, highest, endless, links = self._extents
            meets = ((lowest <= upper) & (highest >= lower)).all(axis=1) | endless
            found.update(links[meets].tolist())
        if self._soft is not None:
            found.update(self._soft.overlapping(lower, upper))
        if self._without_shapes:
            with self._present_poses as poses:
                for row, bounds in self._without_shapes:
                    x, y, z, qx, qy, qz, qw = _POSE.unpack_from(poses, row * _POSE.size)
                    turn = rotation_matrix((qx, qy, qz, qw))
                    center, half = turned_box(bounds.center, bounds.half, turn, (x, y, z))
                    box = zip(center, half, lower, upper, strict=True)
                    if all(c - h <= high and c + h >= low for c, h, low, high in box):
                        found.add(row)
        return sorted(found)

    def _prepare(self, readiness: int) -> None:
        """Update the poses and bounds of the shapes for the present coordinates, unless they are up to date.

        Steps and queries overwrite each other's poses. After any other change that could move a shape, these
        `Queries` are no longer used.
        """
        changes, positions = self._all_shapes.changes, self._positions.tobytes()
        if (
            self._counts[READINESS] < readiness
            or self._placement.changes != changes
            or self._placed_at != positions
        ):
            with self._present_poses:
                self._make_ready[readiness]()
            self._placed_at[:] = positions
            self._placement.changes = changes
        # Not at the first query: many scripts query once, and then change the scene.
        if self._has_asked and not self._placement.place.function:
            with self._present_poses as poses:
                self._tell(poses)
        self._has_asked = True

    def _tell(self, poses: memoryview[int]) -> None:
        """Set the addresses of the kernels that place shapes, for quick calls."""
        tell_placement(
            self._quick,
            (self._make_ready[PLACED], self._structs.launch(link_poses_kernel, first_world=0)),
            self._all_shapes,
            self._pair_table,
            (self._positions, poses),
            self._placed_at,
            self._structs["places"],
            readiness=READINESS,
            has_bare_links=bool(self._without_shapes),
        )


def _one_after_the_other(first: ContactColumns, second: ContactColumns) -> ContactColumns:
    if not second.found:
        return first
    if not first.found:
        return second
    columns = (
        chain(islice(column, first.found), other)
        for column, other in zip(first.columns, second.columns, strict=True)
    )
    return ContactColumns(first.found + second.found, tuple(columns))
