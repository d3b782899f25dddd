"""Rays in many worlds."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.engine.engine import Engine
from carom.engine.queries.ray_hits import RayHits
from carom.engine.row_maps import row_map_struct
from carom.layouts.queries import Places, Rays
from carom.native.kernels import link_poses_kernel, prepare_rays_kernel, rays_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import NUMPY_REAL


class RayCaster:
    """Casts rays in all worlds of an engine at once; `places` are the body and link of each row.

    `hit_number` is 0 for the first hit, 1 for the second; after a hit, hits on the same link within the
    fraction `separation` of the ray are ignored.
    """

    def __init__(
        self,
        engine: Engine,
        places: Sequence[tuple[int, int]],
        *,
        hit_number: int = 0,
        separation: float = 0.0,
    ) -> None:
        self._which = {"hit_number": hit_number, "separation": float(NUMPY_REAL(separation))}
        self._count = engine.arrays.world_count
        self._engine = engine
        self._places = row_map_struct(places, engine.table(Places))
        self._rays = engine.table(Rays)
        self._asked: tuple[int, int] = (0, -1)
        self._cast = engine.task(self._launches)

    def __call__(self, starts: ArrayLike, ends: ArrayLike, mask: int) -> RayHits:
        """Cast rays; see `Worlds.rays`."""
        starts, ends = (
            self._points(self._engine.take(points), name)
            for points, name in ((starts, "starts"), (ends, "ends"))
        )
        if starts.shape[1] != ends.shape[1]:
            raise ValueError(f"there are {starts.shape[1]} starts and {ends.shape[1]} ends")
        number = starts.shape[1]
        total = self._count * number
        if self._rays.reserve({"ray": total}) or (number, mask) != self._asked:
            self._asked = number, mask
            self._cast.renew()
        rays = self._rays.numpy
        rays["ray_start"][:total], rays["ray_end"][:total] = starts.reshape(-1, 3), ends.reshape(-1, 3)
        self._cast()
        names = ("body", "link", "fraction", "position", "normal")
        found = (rays[f"ray_{name}"][:total].copy() for name in names)
        return RayHits(*(array.reshape(self._count, number, *array.shape[1:]) for array in found))

    def _launches(self, structs: KernelStructs) -> list[Launch]:
        structs.update(places=self._places, rays=self._rays.struct())
        number, mask = self._asked
        return [
            structs.launch(link_poses_kernel, first_world=0),
            structs.launch(prepare_rays_kernel, first_world=0),
            structs.launch(
                rays_kernel, first_world=0, count=number, threads=1, mask=mask,
                **self._which,
            ),
        ]  # fmt: skip

    def _points(self, points: ArrayLike, name: str) -> Array:
        array = finite(points, name)
        if array.ndim == 2 and array.shape[1] == 3:
            return np.broadcast_to(array, (self._count, *array.shape))
        if array.ndim == 3 and array.shape[::2] == (self._count, 3):
            return array
        raise ValueError(f"{name} has shape {array.shape}; it must be (n, 3) or ({self._count}, n, 3)")
