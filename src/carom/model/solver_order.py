"""The order in which the solver visits constraints.

The result of Gauss-Seidel sweeps that stop before convergence depends on the order of the rows, so
trajectories equal to Bullet's need Bullet's order. Bullet keeps one list of all constraints in order of
creation; when one is removed, the last takes its place. Before each step the list is sorted by island with a
quicksort that is not stable.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import TypeVar

from carom.native.change import Change

T = TypeVar("T")


def remove_unordered(items: list[T], item: T) -> None:
    """Remove `item` and put the last item in its place."""
    index = items.index(item)
    items[index] = items[-1]
    items.pop()


def quicksort_order(keys: Sequence[int]) -> list[int]:
    """Indices that sort `keys` by Hoare's quicksort around the middle element.

    Unlike a stable sort it also moves equal keys; the result is a function of the keys alone.
    """
    order = list(range(len(keys)))
    ranges = [(0, len(keys) - 1)] if len(keys) > 1 else []
    while ranges:
        low, high = ranges.pop()
        i, j = low, high
        pivot = keys[order[(low + high) // 2]]
        while i <= j:
            while keys[order[i]] < pivot:
                i += 1
            while pivot < keys[order[j]]:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if low < j:
            ranges.append((low, j))
        if i < high:
            ranges.append((i, high))
    return order


def batch_islands(tags: Sequence[int], minimum_size: int) -> list[tuple[int, int]]:
    """First index and length of each run of sorted constraints that are solved together.

    `tags` are the islands of the constraints, ascending, which are joined until a run has more constraints
    than `minimum_size`.
    """
    runs: list[tuple[int, int]] = []
    start = 0
    for end in range(1, len(tags) + 1):
        island_ends = end == len(tags) or tags[end] != tags[end - 1]
        if island_ends and (end - start > minimum_size or end == len(tags)):
            runs.append((start, end - start))
            start = end
    return runs


class IslandTags:
    """Island numbers of bodies that touch nothing.

    Bullet numbers its moving collision objects (one per link) in list order. The number of an island is that
    of its last link. When an object is removed, the last in the list takes its place.
    """

    def __init__(self) -> None:
        self._objects: list[tuple[Hashable, bool]] = []
        # Cached result of `tags()`; None after objects or their order have changed.
        self._tags: dict[Hashable, int] | None = None

    @property
    def links(self) -> list[tuple[Hashable, int]]:
        """Body and link (the base is 0) of every object, in the order of the list."""
        return [key for key, _ in self._objects]  # type: ignore[misc]

    @property
    def moving_links(self) -> list[tuple[Hashable, int]]:
        """As `links`, of those that can move; Bullet numbers them in this order."""
        return [key for key, moves in self._objects if moves]  # type: ignore[misc]

    def reorder(self, links: Sequence[tuple[Hashable, int]]) -> None:
        """Put the objects in another order of `links`; raises `KeyError` if there is no such link."""
        moves = dict(self._objects)
        self._objects = [(link, moves[link]) for link in links]
        self._tags = None

    def add(self, change: Change, body: Hashable, moving: Sequence[bool]) -> None:
        """Append the links of a body, base first, with a change; `moving` says which are not static."""
        change.set(self, "_tags", None)
        change.extend(self._objects, [((body, link), moves) for link, moves in enumerate(moving)])

    def remove(self, change: Change, body: Hashable, link_count: int) -> None:
        """Remove the links of a body, base first, with a change."""
        kept = change.get(self, "_objects").copy()
        index = {key: i for i, (key, _) in enumerate(kept)}
        for link in range(link_count):
            i = index.pop((body, link))
            last_key, last_moves = kept.pop()
            if i < len(kept):
                kept[i] = (last_key, last_moves)
                index[last_key] = i
        self._replace(change, kept)

    def move_base_to_end(self, change: Change, body: Hashable, moving: Sequence[bool]) -> None:
        """Remove the base of a body and append it again; `moving` says which links move then."""
        objects = change.get(self, "_objects").copy()
        index = [key for key, _ in objects].index((body, 0))
        last = objects.pop()
        if index < len(objects):
            objects[index] = last
        objects.append(((body, 0), moving[0]))
        for i, (key, _) in enumerate(objects):
            owner, link = key  # type: ignore[misc]
            if owner == body:
                objects[i] = (key, moving[link])
        self._replace(change, objects)

    def _replace(self, change: Change, objects: list[tuple[Hashable, bool]]) -> None:
        change.set(self, "_tags", None)
        change.set(self, "_objects", objects)

    def tags(self) -> dict[Hashable, int]:
        """Island number of each body that has a moving link."""
        if self._tags is not None:
            return self._tags
        numbers: dict[Hashable, tuple[int, int]] = {}
        number = 0
        for key, moves in self._objects:
            if not moves:
                continue
            body, link = key  # type: ignore[misc]
            if body not in numbers or link > numbers[body][0]:
                numbers[body] = (link, number)
            number += 1
        self._tags = {body: tag for body, (_, tag) in numbers.items()}
        return self._tags
