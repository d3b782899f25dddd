"""The nearest points of two sets of shapes, in one world or in many at once."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.queries import NearestPair
from carom.native.kernels import link_poses_kernel, nearest_pair_kernel, prepare_rays_kernel
from carom.native.launch import KernelStructs, Launch
from carom.native.tables import ArrayTable


class Nearest(NamedTuple):
    """The nearest points of two sets of shapes in each world; meaningless where none are near enough.

    Attributes:
        found: Whether shapes are near enough, (count,).
        distances: Distances [m], negative if shapes overlap, (count,).
        on_first: Points on shapes of the first set, in world axes [m], (count, 3).
        on_second: Points on those of the second set, (count, 3).
        normals: Unit normals there, towards the first set, (count, 3).
    """

    found: np.ndarray
    distances: Array
    on_first: Array
    on_second: Array
    normals: Array


class NearestSearch:
    """The question for a kernel, and its answer.

    Attributes:
        table: The arrays of both: `NearestPair`.
    """

    def __init__(self, table: ArrayTable, count: int) -> None:
        """Ask about `count` worlds by way of a table."""
        self.table: ArrayTable = table
        self._count = count
        table.reserve({"asked": 1, "world": count})

    def ask(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> bool:
        """Write a question: rows of shapes, and up to which distance [m]; whether arrays were replaced."""
        pairs = np.array([*product(first, second)], dtype=np.int32).reshape(-1, 2)
        replaced = self.table.reserve({"pair": max(len(pairs), 1)})
        arrays = self.table.numpy
        arrays["pair_first"][: len(pairs)], arrays["pair_second"][: len(pairs)] = pairs.T
        arrays["asked_count"][:1], arrays["asked_distance"][:1] = len(pairs), max_distance
        return replaced

    def answer(self) -> Nearest:
        """The answer, after the kernel has run."""
        found, distances, points, normals = (
            np.array(self.table.numpy[f"world_{name}"][: self._count])
            for name in ("found", "distance", "point", "normal")
        )
        return Nearest(found > 0, distances, points + distances[:, None] * normals, points, normals)


class NearestFinder:
    """Finds nearest points in all worlds of an engine at once."""

    def __init__(self, engine: Engine) -> None:
        self._search = NearestSearch(engine.table(NearestPair), engine.arrays.world_count)
        self._find = engine.task(self._launches)

    def __call__(self, first: Sequence[int], second: Sequence[int], max_distance: float) -> Nearest:
        """The nearest points of shapes, given by their rows, up to `max_distance` [m] apart."""
        if self._search.ask(first, second, max_distance):
            self._find.renew()
        self._find()
        return self._search.answer()

    def _launches(self, structs: KernelStructs) -> list[Launch]:
        structs.update(nearest_pair=self._search.table.struct())
        kernels = (link_poses_kernel, prepare_rays_kernel, nearest_pair_kernel)
        return [structs.launch(kernel, first_world=0) for kernel in kernels]
