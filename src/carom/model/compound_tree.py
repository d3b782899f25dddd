"""Where Bullet has the parts of a compound in the tree of bounds that it searches them by.

One part after the other is inserted beside the leaf at which a descent from the root ends that takes the
nearer child each time, by the distance of centres along the three axes. It is the second child of a new node.
"""

from __future__ import annotations

from collections.abc import Sequence

from carom.model.bounds import Bounds

_LEVELS = 30
"""Levels of a tree that a path has; parts below them come as they were inserted."""

Path = tuple[int, ...]
"""Which child leads to a part, from the root on: 0 or 1 for each level."""


class _Node:
    """A leaf, which is a part, or a node with two children and the bounds around them."""

    def __init__(self, bounds: Bounds, part: int) -> None:
        self.bounds = bounds
        self.part = part
        self.children: tuple[_Node, _Node] | None = None


def _insert(root: _Node, leaf: _Node) -> None:
    node = root
    while node.children is not None:
        node.bounds = node.bounds.joined(leaf.bounds)
        first, second = node.children
        is_nearer = _apart(leaf.bounds, first.bounds) < _apart(leaf.bounds, second.bounds)
        node = first if is_nearer else second
    node.children = (_Node(node.bounds, node.part), leaf)
    node.bounds = node.bounds.joined(leaf.bounds)


def _apart(a: Bounds, b: Bounds) -> float:
    return sum(abs(x - y) for x, y in zip(a.center, b.center, strict=True))


def tree_paths(bounds: Sequence[Bounds]) -> list[Path]:
    """Paths to parts with these bounds, inserted in this order."""
    root = _Node(bounds[0], 0)
    for part, box in enumerate(bounds[1:], start=1):
        _insert(root, _Node(box, part))
    found: dict[int, Path] = {}
    waiting: list[tuple[_Node, Path]] = [(root, ())]
    while waiting:
        node, path = waiting.pop()
        if node.children is None:
            found[node.part] = path
        else:
            waiting += [(child, (*path, place)) for place, child in enumerate(node.children)]
    return [found[part] for part in range(len(bounds))]


def as_number(path: Path) -> int:
    """A path as a number that is greater for parts which a search reaches earlier: the root's level first."""
    return sum(child << (_LEVELS - 1 - level) for level, child in enumerate(path[:_LEVELS]))
