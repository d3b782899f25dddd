"""Trees of an island are placed so that neighbours are near each other in the matrices of Newton's method."""

from __future__ import annotations

import random

import numpy as np

from carom import World

COUNT = 16


def row_of_balls(order: list[int]) -> World:
    """Balls that touch the next ones in a row on a floor, loaded in an order."""
    balls = "".join(
        f'<body name="b{number}" pos="{0.0999 * number} 0 0.05"><freejoint/><geom size="0.05"/></body>'
        for number in order
    )
    world = World()
    world.load(f'<mujoco><worldbody><geom type="plane" size="5 5 1"/>{balls}</worldbody></mujoco>')
    world.step(20)
    return world


def width(world: World) -> int:
    """Blocks of the matrices beside those of the trees themselves."""
    last = world.engine.workspace.newton_work.numpy["vector_last"][0, : 2 * COUNT]
    return int((last - np.arange(2 * COUNT)).sum())


def shuffled() -> list[int]:
    order = list(range(COUNT))
    random.Random(0).shuffle(order)
    return order


def test_neighbours_in_a_row_are_beside_each_other_in_the_matrix() -> None:
    # Two blocks for each tree: a row couples its own two, and the two of the next tree.
    assert width(row_of_balls(shuffled())) <= 5 * COUNT


def test_the_order_of_bodies_does_not_matter() -> None:
    order = shuffled()
    one, other = row_of_balls(list(range(COUNT))), row_of_balls(order)
    for number in range(COUNT):
        moved = one[f"b{number}"].pose.position - other[f"b{number}"].pose.position
        assert np.abs(moved).max() < 1e-9
