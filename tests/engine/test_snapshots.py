"""Returning to a snapshot repeatedly, when arrays were replaced, by a copy, and in another world."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from carom import World
from carom.scene.snapshot import Snapshot

BALLS = 5


def _world() -> World:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.add_plane()
    for place in range(BALLS):
        world.add_sphere(0.1, position=(0.15 * place, 0.0, 0.1 + 0.1 * place))
    world.step(10)
    return world


def _positions(world: World) -> np.ndarray:
    # What comes behind is room for more bodies.
    return world.position[: 7 * (BALLS + 1)].copy()


def _went_on(world: World) -> np.ndarray:
    world.step(20)
    return _positions(world)


def test_every_return_begins_the_same_motion():
    world = _world()
    state, start = world.snapshot(), _positions(world)
    expected = _went_on(world)
    for _ in range(3):
        world.restore(state)
        assert (_positions(world) == start).all()
        assert (_went_on(world) == expected).all()


def test_a_return_reaches_arrays_that_have_been_replaced():
    world = _world()
    state = world.snapshot()
    expected = _went_on(world)
    world.restore(state)
    more = [world.add_sphere(0.1, position=(0.0, 5.0 + place, 9.0)) for place in range(100)]
    for body in more:
        world.remove(body.id)
    world.step(5)
    world.restore(state)
    assert (_went_on(world) == expected).all()


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda state: pickle.loads(pickle.dumps(state))])
def test_a_copy_of_a_snapshot_has_its_own_numbers(duplicate):
    world = _world()
    state = world.snapshot()
    world.restore(state)
    other: Snapshot = duplicate(state)
    other.state["dof_velocity"][:] = 0.0
    assert state.state["dof_velocity"].any()
    world.restore(other)
    assert not world.velocity.any()
    world.restore(state)
    assert world.velocity.any()


def test_arrays_of_a_snapshot_can_be_exchanged():
    world = _world()
    state = world.snapshot()
    world.restore(state)
    state.state["dof_velocity"] = np.zeros_like(state.state["dof_velocity"])
    world.restore(state)
    assert not world.velocity.any()


def test_two_worlds_return_to_one_snapshot_in_turns():
    first, second = _world(), _world()
    state = first.snapshot()
    expected = _went_on(first)
    for world in (first, second, first, second):
        world.restore(state)
        assert (_went_on(world) == expected).all()


def test_poses_of_links_follow_all_bodies():
    world = _world()
    state = world.snapshot()
    world.step(20)
    world.restore(state, update_poses=True)
    for body in world.bodies.values():
        first = body.first_position
        pose = world.link_pose[body.first_link]
        np.testing.assert_array_equal(pose, world.position[first : first + 7])
