"""Removal of shapes from the overlaps of a world, between steps.

`kernels.contact.overlaps` says what overlaps are, and changes them within steps.
"""

from __future__ import annotations

import numpy as np

from carom.layouts.contacts import NO_MANIFOLD


def without_shapes(
    pairs: np.ndarray, places: np.ndarray, manifolds: np.ndarray, first: int, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The overlaps that remain when the shapes in rows [first, first + count) are removed.

    As in Bullet, one shape after the other loses its overlaps, in the order of the pair cache, and the last
    one moves to the place of each that is removed.

    Args:
        pairs: `Contacts.overlap_shapes` of a world, shape (n, 2).
        places: `Contacts.overlap_place`, shape (n,).
        manifolds: `Contacts.overlap_manifold`, shape (n,).
        first: Row of the first shape.
        count: Number of shapes.

    Returns:
        The same three of the world without these shapes; rows of later shapes are `count` less.
    """
    end = first + count
    doomed = ((pairs >= first) & (pairs < end)).any(axis=1)
    left = pairs - count * (pairs >= end), places.copy(), manifolds.copy()
    if not doomed.any():
        return left
    cache, order = np.argsort(places).tolist(), np.argsort(manifolds).tolist()
    # Those without a manifold come first.
    del order[: int((manifolds == NO_MANIFOLD).sum())]
    for shape in range(first, end):
        _remove_shape(set(np.flatnonzero((pairs == shape).any(axis=1)).tolist()), cache, order)
    left[1][cache] = np.arange(len(cache))
    left[2][order] = np.arange(len(order))
    return left[0][~doomed], left[1][~doomed], left[2][~doomed]


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
