"""Geometric questions about a world as it stands: rays, nearest points, overlaps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from itertools import product
from typing import Any, NamedTuple, cast

import numpy as np
import warp as wp

from carom.collision.closest import closest_points_kernel, place_shapes_kernel
from carom.collision.rays import prepare_rays_kernel, rays_kernel
from carom.description.pose import Vector3 as Point
from carom.model.codes import PLANE
from carom.model.launch import KernelStructs, Launch, argument_indices, launch
from carom.model.real import NUMPY_REAL, Vector3, Vector8, real
from carom.touch_arrays import TouchArrays

Points = np.ndarray | Sequence[Sequence[float]]

# A distance that counts as none; column of a row of `closest_points_kernel` that tells if it is filled.
_FAR = 1e30
_FOUND = 7
# Sets of pairs of links whose shapes are remembered: scripts ask for the same ones step by step.
_MOST_SHAPE_PAIRS = 64


class RayHits(NamedTuple):
    """What rays hit, an item for each.

    Attributes:
        link: Row of the link in the world's arrays, -1 for none.
        fraction: Where along the ray; 1 for none.
        position: The same in world axes [m].
        normal: In world axes; 0 for none.
    """

    link: list[int]
    fraction: list[float]
    position: list[list[float]]
    normal: list[list[float]]


class NearestPoints(NamedTuple):
    """The nearest points of two links.

    Attributes:
        on_a: Point on the first link, in world axes [m].
        on_b: Point on the second link.
        normal: On the second link, towards the first.
        distance: Between them [m]; negative if they overlap.
    """

    on_a: Point
    on_b: Point
    normal: Point
    distance: float


class Queries:
    """Launches of the collision queries of a world, over its present arrays.

    Args:
        structs: Warp structs by the name kernels give them.
        present_poses: `World.present_poses`.
        touch: The arrays of shapes.
        device: Warp device name.
    """

    def __init__(
        self,
        structs: KernelStructs,
        present_poses: Callable[[], AbstractContextManager[None]],
        touch: TouchArrays,
        device: str,
    ) -> None:
        self._structs = structs
        self._device = device
        self._present_poses = present_poses
        self._shape_count = touch.shapes.shape_count
        self._shapes = touch.shapes.table.numpy
        self._pairs = touch.pairs.numpy
        self._prepare_rays = launch(prepare_rays_kernel, structs, device)
        self._place_shapes = launch(place_shapes_kernel, structs, device)
        self._casts: dict[int, RayCast] = {}
        self._searches: dict[int, PairSearch] = {}
        self._shape_pairs: dict[tuple[tuple[int, int], ...], tuple[list[tuple[int, int]], np.ndarray]] = {}

    def cast_rays(
        self,
        starts: Points,
        ends: Points,
        *,
        mask: int = -1,
        hit_number: int = 0,
        separation: float = 0.0,
    ) -> RayHits:
        """What rays hit.

        Args:
            starts: Their starts in world axes [m], shape (n, 3).
            ends: Their ends, shape (n, 3).
            mask: Collision groups that are hit.
            hit_number: 0 for the first hit of each ray, 1 for the second, and so on.
            separation: Later hits on a link less than this fraction of the ray after one do not count.
        """
        count = len(starts)
        cast = self._casts.get(count)
        if cast is None:
            self._casts.clear()
            cast = self._casts[count] = RayCast(self._structs, count, self._device)
        self._place(self._prepare_rays)
        return cast.run(self._shapes, starts, ends, mask, hit_number, separation)

    def nearest(self, pairs: Sequence[tuple[int, int]], reach: float) -> list[tuple[int, int, NearestPoints]]:
        """The nearest points of all shapes of pairs of links, without those farther apart than `reach`.

        Args:
            pairs: Rows of links in the world's arrays.
            reach: Largest distance [m].

        Returns:
            The links and the points, in the order of `pairs`, then of the shapes of each link.
        """
        key = tuple(pairs)
        known = self._shape_pairs.get(key)
        if known is None:
            if len(self._shape_pairs) >= _MOST_SHAPE_PAIRS:
                self._shape_pairs.clear()
            known = self._shape_pairs[key] = self._find_shape_pairs(key)
        links, shapes = known
        if not links:
            return []
        count = len(links)
        search = self._searches.get(count)
        if search is None:
            self._searches.clear()
            search = self._searches[count] = PairSearch(self._structs, count, self._device)
        self._place(self._place_shapes)
        found = search.run(shapes, min(reach, _FAR))
        return [(a, b, _points(terms)) for (a, b), terms in zip(links, found, strict=True) if terms[_FOUND]]

    def _find_shape_pairs(self, pairs: Sequence[tuple[int, int]]) -> tuple[list[tuple[int, int]], np.ndarray]:
        """All pairs of shapes of pairs of links: the links, and the shapes of the first and the second."""
        links, shapes = [], []
        for a, b in pairs:
            for pair in product(self._shapes_of(a), self._shapes_of(b)):
                links.append((a, b))
                shapes.append(pair)
        return links, np.array(shapes, dtype=np.int32).reshape(-1, 2).T

    def _place(self, prepare: Launch) -> None:
        """Run a kernel that places the shapes by poses of the links that are up to date."""
        with self._present_poses():
            prepare()

    def _shapes_of(self, link: int) -> range:
        first = int(self._shapes["link_first_shape"][link])
        return range(first, first + int(self._shapes["link_shape_count"][link]))

    def overlapping(self, lower: Sequence[float], upper: Sequence[float]) -> list[int]:
        """Rows of the links whose bounds meet a box.

        Args:
            lower: Lowest corner of the box in world axes [m].
            upper: Its highest corner.
        """
        count = self._shape_count
        if not count:
            return []
        self._place(self._place_shapes)
        endless = self._shapes["shape_kind"][:count] == PLANE
        meets = (self._pairs["shape_lower"][0, :count] <= np.asarray(upper)).all(axis=1)
        meets &= (self._pairs["shape_upper"][0, :count] >= np.asarray(lower)).all(axis=1)
        return np.unique(self._shapes["shape_link"][:count][meets | endless]).tolist()


class PairSearch:
    """A launch over a number of pairs of shapes, and its memory."""

    def __init__(self, structs: KernelStructs, count: int, device: str) -> None:
        self._pairs = np.zeros((2, count), dtype=np.int32)
        self._found = np.zeros((1, count, 8), dtype=NUMPY_REAL)
        rows = [wp.array(shapes, dtype=wp.int32, device=device, copy=False) for shapes in self._pairs]
        found: Any = wp.array(self._found, dtype=cast("Any", Vector8), device=device, copy=False)
        arguments = [structs["shapes"], structs["pairs"], *rows, NUMPY_REAL(0.0), found]
        self._launch = Launch(closest_points_kernel, 1, arguments, device)
        self._reach_at = argument_indices(closest_points_kernel)["reach"]

    def run(self, shapes: np.ndarray, reach: float) -> list[list[float]]:
        """A row for each pair, as `closest_points_kernel` leaves it."""
        self._pairs[:] = shapes
        self._launch.replace(self._reach_at, reach)
        self._launch()
        return self._found[0].tolist()


class RayCast:
    """A launch over a number of rays, and its memory."""

    def __init__(self, structs: KernelStructs, count: int, device: str) -> None:
        def memory(shape: tuple[int, ...], scalar: Any, dtype: Any) -> tuple[np.ndarray, Any]:
            numbers = np.zeros(shape, dtype=scalar)
            return numbers, wp.array(numbers, dtype=dtype, device=device, copy=False)

        self._starts, starts = memory((count, 3), NUMPY_REAL, Vector3)
        self._ends, ends = memory((count, 3), NUMPY_REAL, Vector3)
        self._shape, shape = memory((count,), np.int32, wp.int32)
        self._fraction, fraction = memory((count,), NUMPY_REAL, real)
        self._normal, normal = memory((count, 3), NUMPY_REAL, Vector3)
        arguments = [
            structs["shapes"],
            structs["pairs"],
            0,
            starts,
            ends,
            -1,
            0,
            NUMPY_REAL(0.0),
            shape,
            fraction,
            normal,
        ]
        self._launch = Launch(rays_kernel, count, arguments, device)
        self._index = argument_indices(rays_kernel)

    def run(
        self,
        shapes: dict[str, np.ndarray],
        starts: Points,
        ends: Points,
        mask: int,
        hit_number: int,
        separation: float,
    ) -> RayHits:
        """Cast the rays; the arguments are those of `Queries.cast_rays`."""
        self._starts[:] = starts
        self._ends[:] = ends
        self._launch.replace(self._index["mask"], mask)
        self._launch.replace(self._index["hit_number"], hit_number)
        self._launch.replace(self._index["separation"], separation)
        self._launch()
        link = shapes["shape_link"][self._shape]
        link[self._shape < 0] = -1
        position = self._starts + self._fraction[:, None] * (self._ends - self._starts)
        return RayHits(link.tolist(), self._fraction.tolist(), position.tolist(), self._normal.tolist())


def _points(terms: list[float]) -> NearestPoints:
    bx, by, bz, nx, ny, nz, distance = terms[:_FOUND]
    on_a = (bx + distance * nx, by + distance * ny, bz + distance * nz)
    return NearestPoints(on_a, (bx, by, bz), (nx, ny, nz), distance)
