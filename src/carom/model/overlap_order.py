"""Removal of shapes from the overlaps of a world, between steps.

`kernels.contact.overlaps` says what overlaps are, and changes them within steps.
"""

from __future__ import annotations

import numpy as np

from carom.layouts.contacts import NO_MANIFOLD


def without_shapes(overlaps: np.ndarray, first: int, count: int) -> np.ndarray:
    """The overlaps, (n, 4), that remain when the shapes in rows [first, first + count) are removed.

    As in Bullet, one shape after the other loses its overlaps, in the order of the pair cache, and the last
    one moves to the place of each that is removed. In the result rows of later shapes are `count` less.
    """
    end = first + count
    pairs = overlaps[:, :2]
    doomed = ((pairs >= first) & (pairs < end)).any(axis=1)
    left = overlaps.copy()
    if doomed.any():
        cache, manifolds = np.argsort(overlaps[:, 2]).tolist(), np.argsort(overlaps[:, 3]).tolist()
        # Those without a manifold come first.
        del manifolds[: int((overlaps[:, 3] == NO_MANIFOLD).sum())]
        for shape in range(first, end):
            _remove_shape(set(np.flatnonzero((pairs == shape).any(axis=1)).tolist()), cache, manifolds)
        left[cache, 2] = np.arange(len(cache))
        left[manifolds, 3] = np.arange(len(manifolds))
        left = left[~doomed]
    left[:, :2] -= count * (left[:, :2] >= end)
    return left


def _remove_shape(doomed: set[int], cache: list[int], manifolds: list[int]) -> None:
    """Remove the overlaps of a shape, by row, from the pair cache and from the order of manifolds."""
    places = {row: place for place, row in enumerate(manifolds)}
    for row in [row for row in cache if row in doomed and row in places]:
        place, last = places.pop(row), manifolds.pop()
        if last != row:
            manifolds[place], places[last] = last, place
    i = 0
    while i < len(cache):
        if cache[i] in doomed:
            last = cache.pop()
            if i < len(cache):
                cache[i] = last
        else:
            i += 1
