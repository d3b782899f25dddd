"""Ray casts: arrays of their arguments and results."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from carom.description.pose import Vector3
from carom.engine.queries.question import Question
from carom.layouts.queries import Rays
from carom.native.kernels import rays_kernel
from carom.native.launch import KernelStructs
from carom.native.tables import NUMPY_REAL, ArrayTable, numbers_of

Points = np.ndarray | Sequence[Sequence[float]]

_TYPE_CODE = np.dtype(NUMPY_REAL).char
_VECTOR = struct.Struct(f"3{_TYPE_CODE}")

RayTuple = tuple[int, int, float, Vector3, Vector3]
"""The numbers of a `RayHit`, in that order."""


class RayHit(NamedTuple):
    """The result of a ray.

    Attributes:
        body: Id of the body that it hits; -1 without a hit.
        link: Index of the link, -1 for the base and without a hit.
        fraction: Fraction along the ray: 0 at the start, 1 at the end and without a hit.
        position: The point in world axes [m]; zeros without a hit.
        normal: Unit normal of the surface there; zeros without a hit.
    """

    body: int
    link: int
    fraction: float
    position: Vector3
    normal: Vector3

    @property
    def success(self) -> bool:
        """Whether the ray hits anything."""
        return self.body >= 0


class RayCast:
    """Cast rays at the shapes of a world."""

    def __init__(self, structs: KernelStructs) -> None:
        self._cast = Question(
            rays_kernel,
            structs,
            "rays",
            ArrayTable(Rays),
            {"mask": -1, "hit_number": 0, "separation": NUMPY_REAL(0.0)},
            first_world=0,
            threads=1,
        )
        self._view()

    def __call__(
        self, starts: Points, ends: Points, mask: int, hit_number: int, separation: float
    ) -> tuple[RayTuple, ...]:
        """Cast rays; the arguments are those of `Queries.ray_tuples`."""
        count = len(starts)
        if count > self._cast.room:
            self._cast.reserve(count, self._view)
        size = count * _VECTOR.size
        self._starts[:size] = _packed(starts)
        self._ends[:size] = _packed(ends)
        self._cast(count, mask, hit_number, separation)
        bodies = self._bodies[:count]
        positions, normals = _VECTOR.iter_unpack(self._positions), _VECTOR.iter_unpack(self._normals)
        return tuple(zip(bodies, self._links, self._fractions, positions, normals, strict=False))

    def one(self, start: Vector3, end: Vector3, mask: int, hit_number: int, separation: float) -> RayTuple:
        """Cast one ray; the other arguments are those of `Queries.ray_tuples`."""
        _VECTOR.pack_into(self._starts, 0, *start)
        _VECTOR.pack_into(self._ends, 0, *end)
        self._cast(1, mask, hit_number, separation)
        position, normal = _VECTOR.unpack_from(self._positions), _VECTOR.unpack_from(self._normals)
        return self._bodies[0], self._links[0], self._fractions[0], position, normal

    def _view(self) -> None:
        """Keep views of the memory of the present arrays."""
        arrays, memory = self._cast.arrays.numpy, self._cast.arrays.bytes_of
        self._starts, self._ends = memory("ray_start"), memory("ray_end")
        self._positions, self._normals = memory("ray_position"), memory("ray_normal")
        self._bodies: memoryview[int] = arrays["ray_body"].data
        self._links: memoryview[int] = arrays["ray_link"].data
        self._fractions = numbers_of(arrays["ray_fraction"])


def _packed(points: Points) -> bytes:
    """The coordinates of points as bytes, one point after the other."""
    if isinstance(points, np.ndarray):
        return points.astype(NUMPY_REAL, copy=False).tobytes()
    return struct.pack(f"{3 * len(points)}{_TYPE_CODE}", *chain.from_iterable(points))
