"""Overlaps of a world that shapes lose between steps.

`kernels.contact.overlaps` says what overlaps are, and changes them within steps.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from carom.layouts.contacts import NO_MANIFOLD


def without_overlaps(
    pairs: np.ndarray,
    places: np.ndarray,
    manifolds: np.ndarray,
    others: Iterable[np.ndarray],
    shapes: Iterable[int],
) -> tuple[np.ndarray, ...]:
    """The overlaps that remain when some shapes lose all of theirs.

    As in Bullet, one shape after the other loses its overlaps, in the order of the pair cache, and the last
    one moves to the place of each that is removed.

    Args:
        pairs: `Contacts.overlap_shapes` of a world, shape (n, 2).
        places: `Contacts.overlap_place`, shape (n,).
        manifolds: `Contacts.overlap_manifold`, shape (n,).
        others: Other fields of overlaps, shape (n,).
        shapes: The rows of these shapes.

    Returns:
        The same arrays without the overlaps that are lost.
    """
    lost = [np.flatnonzero((pairs == shape).any(axis=1)).tolist() for shape in shapes]
    left = tuple(array.copy() for array in (pairs, places, manifolds, *others))
    if not any(lost):
        return left
    cache, order = np.argsort(places).tolist(), np.argsort(manifolds).tolist()
    # Those without a manifold come first.
    del order[: int((manifolds == NO_MANIFOLD).sum())]
    for rows in lost:
        _remove_rows(set(rows), cache, order)
    left[1][cache] = np.arange(len(cache))
    left[2][order] = np.arange(len(order))
    kept = sorted(cache)
    return tuple(array[kept] for array in left)


def _remove_rows(doomed: set[int], cache: list[int], manifolds: list[int]) -> None:
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
