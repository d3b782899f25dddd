"""Where Bullet has the parts of a compound in its tree."""

from __future__ import annotations

import pytest

from carom.description.shapes.bounds import Bounds
from carom.model.placed_pieces import as_number, tree_paths

MANY = 2000


def order(*places: tuple[float, float]) -> list[int]:
    """Parts at these places in the order in which a search reaches them."""
    bounds = [Bounds((x, y, 0.0), (0.1, 0.1, 0.1)) for x, y in places]
    numbers = [as_number(path) for path in tree_paths(bounds)]
    return sorted(range(len(numbers)), key=lambda part: -numbers[part])


@pytest.mark.parametrize(
    ("places", "expected"),
    [
        ([(0, 0)], [0]),
        ([(0, 0), (5, 0)], [1, 0]),
        ([(0, 0), (5, 0), (4, 0)], [2, 1, 0]),
        ([(0, 0), (5, 0), (1, 0)], [1, 2, 0]),
        ([(0, 0), (5, 0), (1, 0), (4, 0)], [3, 1, 2, 0]),
        ([(0, 0), (5, 0), (1, 0), (0, 2)], [1, 2, 3, 0]),
    ],
)
def test_a_part_is_put_beside_the_nearer_child(places: list[tuple[float, float]], expected: list[int]):
    assert order(*places) == expected


def test_trees_may_be_deep():
    paths = tree_paths([Bounds((2.0**place, 0.0, 0.0), (0.0, 0.0, 0.0)) for place in range(MANY // 2)])
    assert max(map(len, paths)) == MANY // 2 - 1
    assert all(0 <= as_number(path) < 2**30 for path in paths)
