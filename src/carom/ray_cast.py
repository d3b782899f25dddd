"""Casting rays: the memory of the questions and of the answers."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from carom.collision.ray_packets import Rays
from carom.collision.rays import rays_kernel
from carom.description.pose import Vector3
from carom.model.arrays import ArrayTable, numbers_of
from carom.model.launch import KernelStructs
from carom.model.real import NUMPY_REAL
from carom.question import Question

Points = np.ndarray | Sequence[Sequence[float]]

_TYPE_CODE = np.dtype(NUMPY_REAL).char
_VECTOR = struct.Struct(f"3{_TYPE_CODE}")


class RayHits(NamedTuple):
    """What rays hit, an item for each.

    Attributes:
        link: Row of the link in the world's arrays; -1 for none.
        fraction: Where along the ray; 1 for none.
        position: The same in world axes [m]; 0 for none.
        normal: In world axes; 0 for none.
    """

    link: list[int]
    fraction: list[float]
    position: list[Vector3]
    normal: list[Vector3]


class RayHit(NamedTuple):
    """What one ray hits; see `RayHits`."""

    link: int
    fraction: float
    position: Vector3
    normal: Vector3


class RayCast:
    """The rays of a world.

    Args:
        structs: Warp structs by the name kernels give them.
        device: Warp device name.
    """

    def __init__(self, structs: KernelStructs, device: str) -> None:
        self._cast = Question(
            rays_kernel,
            structs,
            "rays",
            ArrayTable(Rays, None),
            device,
            {"mask": -1, "hit_number": 0, "separation": NUMPY_REAL(0.0)},
            world=0,
            threads=1,
        )
        self._view()

    def __call__(
        self, starts: Points, ends: Points, mask: int, hit_number: int, separation: float
    ) -> RayHits:
        """Cast rays; the arguments are those of `Queries.cast_rays`."""
        count = len(starts)
        if count > self._cast.room:
            self._cast.reserve(count)
            self._view()
        size = count * _VECTOR.size
        self._starts[:size] = _packed(starts)
        self._ends[:size] = _packed(ends)
        self._cast(count, mask, hit_number, separation)
        arrays = self._cast.arrays.numpy
        return RayHits(
            arrays["ray_link"][:count].tolist(),
            arrays["ray_fraction"][:count].tolist(),
            list(_VECTOR.iter_unpack(self._positions[:size])),
            list(_VECTOR.iter_unpack(self._normals[:size])),
        )

    def one(self, start: Vector3, end: Vector3, mask: int, hit_number: int, separation: float) -> RayHit:
        """Cast one ray."""
        _VECTOR.pack_into(self._starts, 0, *start)
        _VECTOR.pack_into(self._ends, 0, *end)
        self._cast(1, mask, hit_number, separation)
        position, normal = _VECTOR.unpack_from(self._positions), _VECTOR.unpack_from(self._normals)
        return RayHit(self._links[0], self._fractions[0], position, normal)

    def _view(self) -> None:
        """Take the memory of the present arrays."""
        arrays, memory = self._cast.arrays.numpy, self._cast.arrays.bytes_of
        self._starts, self._ends = memory("ray_start"), memory("ray_end")
        self._positions, self._normals = memory("ray_position"), memory("ray_normal")
        self._links: memoryview[int] = arrays["ray_link"].data
        self._fractions = numbers_of(arrays["ray_fraction"])


def _packed(points: Points) -> bytes:
    """Points one after the other in memory."""
    if isinstance(points, np.ndarray):
        return points.astype(NUMPY_REAL, copy=False).tobytes()
    return struct.pack(f"{3 * len(points)}{_TYPE_CODE}", *chain.from_iterable(points))
