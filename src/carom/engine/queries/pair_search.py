"""Nearest-point queries between links: arrays of their arguments and results."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from struct import Struct
from typing import NamedTuple

import numpy as np

from carom.description.pose import Vector3
from carom.engine.contact_arrays import ContactArrays
from carom.engine.queries.question import Question
from carom.engine.queries.quick_queries import tell_search
from carom.engine.quick_scene import QuickScene
from carom.layouts.queries import Searches
from carom.native.kernels import closest_points_kernel
from carom.native.launch import KernelStructs
from carom.native.tables import NUMPY_REAL, ArrayTable

# Numbers of a `Candidate`: point, normal and distance; the rest is skipped.
_CANDIDATE = Struct(f"7{np.dtype(NUMPY_REAL).char}8x")
_INDEX = np.dtype(np.int32)
# Maximum number of cached queries; scripts query the same links in each step.
_MAX_REMEMBERED = 64


NearestPoints = tuple[int, int, Vector3, Vector3, Vector3, float]
"""Rows of two links, point on the first link, on the second link (in world axes [m]), normal on the second
link towards the first, distance [m] (negative if they overlap)."""


class ShapePairs(NamedTuple):
    """All pairs of shapes of pairs of links.

    Attributes:
        links: Rows of the two links of each pair of shapes.
        first: Rows of the shapes of the first links, as bytes of an int32 array.
        second: Rows of the shapes of the second links, likewise.
    """

    links: list[tuple[int, int]]
    first: bytes
    second: bytes


class PairSearch:
    """Find the nearest points of shapes of a world; addresses for quick calls are set in `quick`."""

    def __init__(self, structs: KernelStructs, contact_arrays: ContactArrays, quick: QuickScene) -> None:
        self._quick = quick
        self._shapes = contact_arrays.shapes.table.numpy
        self._remembered: dict[tuple[Sequence[int], Sequence[int]], ShapePairs] = {}
        self._search = Question(
            closest_points_kernel,
            structs,
            "searches",
            ArrayTable(Searches, 1),
            {"max_distance": NUMPY_REAL(0.0)},
        )
        self._view()

    def shape_pairs(self, first: Sequence[int], second: Sequence[int]) -> ShapePairs:
        """All pairs of a shape of a link of `first` and a shape of a link of `second`."""
        known = self._remembered.get((first, second))
        if known is None:
            if len(self._remembered) >= _MAX_REMEMBERED:
                self._remembered.clear()
            known = self._remembered[first, second] = self._find_pairs(first, second)
        return known

    def __call__(self, pairs: ShapePairs, max_distance: float) -> list[NearestPoints]:
        """The nearest points of those pairs of shapes whose distance is at most `max_distance` [m]."""
        count = len(pairs.links)
        if count > self._search.room:
            self._search.reserve(count, self._view)
        size = count * _INDEX.itemsize
        self._first[:size], self._second[:size] = pairs.first, pairs.second
        self._search(count, max_distance)
        found = self._count[0]
        if not found:
            return []
        rows = zip(range(found), self._pair, _CANDIDATE.iter_unpack(self._found), strict=False)
        return [
            (
                *pairs.links[pair],
                (x + distance * nx, y + distance * ny, z + distance * nz),
                (x, y, z),
                (nx, ny, nz),
                distance,
            )
            for _, pair, (x, y, z, nx, ny, nz, distance) in rows
        ]

    def _find_pairs(self, first: Sequence[int], second: Sequence[int]) -> ShapePairs:
        links, shapes = [], []
        for a, b in product(first, second):
            pairs = list(product(self._shapes_of(a), self._shapes_of(b)))
            if len(pairs) > 1:
                pairs.sort(key=self._place_in_search, reverse=True)
            links += [(a, b)] * len(pairs)
            shapes += pairs
        sides = np.array(shapes, dtype=_INDEX).reshape(-1, 2).T
        return ShapePairs(links, sides[0].tobytes(), sides[1].tobytes())

    def _place_in_search(self, pair: tuple[int, int]) -> int:
        """A number that is greater for pairs of shapes of two links which Bullet comes across earlier.

        Level by level the second shape's place in the tree of its link counts before that of the first.
        """
        first, second = (_spread(int(self._shapes["shape_path"][0, shape])) for shape in pair)
        return 2 * second + first

    def _shapes_of(self, link: int) -> range:
        first = int(self._shapes["link_first_shape"][link])
        return range(first, first + int(self._shapes["link_shape_count"][link]))

    def _view(self) -> None:
        """Keep views of the memory of the present arrays."""
        arrays, memory = self._search.arrays.numpy, self._search.arrays.bytes_of
        self._first, self._second = memory("search_first"), memory("search_second")
        self._count: memoryview[int] = arrays["search_count"][0].data
        self._pair: memoryview[int] = arrays["search_pair"][0].data
        self._found = memory("search_found")
        tell_search(self._quick, self._search)


def _spread(number: int) -> int:
    """A number with a zero before each of its bits."""
    return int(f"{number:b}", 4)
