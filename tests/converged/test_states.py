"""Worlds with rigid contacts: copied, restored, saved, multiplied; and what is not built for them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.converged.rigid_worlds import centres, rigid_world, tower

from carom import World, Worlds


def _kicked_tower() -> World:
    """A tower in the middle of sliding and rocking."""
    world = rigid_world()
    boxes = tower(world, 4)
    world.step(60)
    boxes[2].set_base_velocity((0.4, 0.1, 0.0), (0.0, 0.3, 0.0))
    world.step(10)
    return world


def test_a_restored_world_moves_bit_by_bit_as_before() -> None:
    world = _kicked_tower()
    state = world.snapshot()
    world.step(50)
    expected = world.position.copy()
    world.restore(state)
    world.step(50)
    assert np.array_equal(world.position, expected)


def test_copies_and_saved_worlds_do_too(tmp_path: Path) -> None:
    world = _kicked_tower()
    world.save(tmp_path / "world.carom")
    copy, loaded = world.copy(), World()
    loaded.load(tmp_path / "world.carom")
    assert copy.contact == loaded.contact == "rigid"
    for each in (world, copy, loaded):
        each.step(50)
    assert np.array_equal(copy.position, world.position)
    assert np.array_equal(loaded.position, world.position)


def test_worlds_move_as_a_lone_world() -> None:
    world = _kicked_tower()
    worlds = Worlds(world, 3)
    world.step(50)
    worlds.step(50)
    ends = np.array([worlds.extract(number).position for number in range(3)])
    assert np.array_equal(ends, np.array([world.position] * 3))


def test_a_state_of_another_law_brings_no_impulses_along() -> None:
    world = rigid_world()
    boxes = tower(world, 3)
    world.step(120)
    state = world.snapshot()
    start = centres(boxes)
    world.contact = "bullet"
    world.restore(state)
    assert not world.contact_arrays.contacts.numpy["count_contacts"][0, 0]
    world.contact = "rigid"
    world.step(240)
    assert np.abs(centres(boxes) - start).max() < 1e-5


def test_the_law_can_be_changed_and_stays_through_a_reset() -> None:
    world = World()
    assert world.contact == "compliant"
    world.contact = "rigid"
    world.clear()
    assert world.contact == "rigid"
    assert world.parameters.contact == "rigid"


def test_unknown_laws_are_refused() -> None:
    with pytest.raises(ValueError, match="'bullet', 'rigid' or 'compliant', not 'stiff'"):
        World(contact="stiff")
    world = World()
    with pytest.raises(ValueError, match="not 'soft'"):
        world.contact = "soft"
    assert world.contact == "compliant"


def test_worlds_on_other_devices_are_refused() -> None:
    with pytest.raises(NotImplementedError, match="contact='rigid'"):
        Worlds(rigid_world(), 2, device="warp-cpu")
