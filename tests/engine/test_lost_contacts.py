"""A body that is removed takes its contacts along; what it was not near does not notice."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom import World
from carom.engine.lost_contacts import island_of


def settling() -> World:
    """A cube that was dropped on a plane and still rocks."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf("plane.urdf", as_pybullet=True)
    world.load_urdf("cube_small.urdf", (0.0, 0.0, 0.05), as_pybullet=True)
    world.step(25)
    return world


def counters(world: World) -> list[float]:
    contacts = world.contact_arrays
    return contacts.contacts.numpy["contact_warm_start"][0, : contacts.contact_count].tolist()


def test_a_body_that_comes_and_goes_far_away_changes_no_bit() -> None:
    world, alone = settling(), settling()
    for _ in range(10):
        far = [world.load_urdf("cube_small.urdf", (9.0, 0.04 * n, 0.02), as_pybullet=True) for n in range(3)]
        world.step(2)
        for body in far:
            world.remove(body.id)
        world.step()
        alone.step(3)
        assert world.snapshot().state["position"].tobytes() == alone.snapshot().state["position"].tobytes()


@pytest.mark.parametrize(("removed", "left", "cold"), [(0, 4, 4), (1, 4, 0), (2, 8, 4), (3, 8, 0)])
def test_what_is_left_of_an_island_starts_from_no_impulses(removed: int, left: int, cold: int) -> None:
    """Of two cubes, one on the other, and one beside them, all on a plane."""
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf("plane.urdf", as_pybullet=True)
    for place in ((0.0, 0.0, 0.025), (0.0, 0.0, 0.075), (0.5, 0.0, 0.025)):
        world.load_urdf("cube_small.urdf", place, as_pybullet=True)
    world.step(100)
    before = counters(world)
    assert len(before) == 12
    assert min(before) >= 1.0
    world.remove(removed)
    after = counters(world)
    assert len(after) == left
    assert sum(counter < 1.0 for counter in after) == cold


@given(
    st.integers(1, 8).flatmap(
        lambda count: st.tuples(
            st.integers(0, count - 1),
            st.lists(st.tuples(st.integers(-1, count - 1), st.integers(-1, count - 1)), max_size=12),
            st.lists(st.booleans(), min_size=count, max_size=count),
        )
    )
)
def test_the_island_of_a_tree_is_all_that_it_reaches(
    graph: tuple[int, list[tuple[int, int]], list[bool]],
) -> None:
    tree, pairs, can_move = graph
    reached = {tree}
    for _ in can_move:
        for pair in pairs:
            if reached & set(pair):
                reached |= {other for other in pair if other >= 0 and can_move[other]}
    island = island_of(tree, np.array(pairs, dtype=np.int32).reshape(-1, 2), np.array(can_move))
    assert set(np.flatnonzero(island).tolist()) == reached
