"""Whether a world among many is, bit for bit, the one that it would have been alone."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from carom import World, Worlds
from carom.layouts.contacts import THERE
from carom.native.tables import ArrayTable

# What became of the last step, and what a run of several steps counts, is no state.
_NOT_STATE = ("status_entry",)


def stir(state: dict[str, np.ndarray], world: int, seed: int, used: dict[str, int]) -> None:
    """Disturb one world of some arrays, by numbers that belong to a seed: velocities and motor targets."""
    random = np.random.default_rng(seed)
    dofs = used["dof"]
    state["dof_velocity"][world, :dofs] += random.normal(0.0, 1e-2, dofs) * (
        state["dof_velocity"][world, :dofs] != 0.0
    )
    state["dof_motor"][world, :dofs, 0] += random.normal(0.0, 1e-3, dofs)


def stirred(scene: World, seed: int) -> World:
    """A copy of a scene, disturbed as world number `seed` of `stirred_worlds` is."""
    world = scene.copy()
    stir(world.arrays.state.numpy, 0, seed, world.arrays.used)
    return world


def stirred_worlds(scene: World, count: int, threads: int) -> Worlds:
    """Copies of a scene, each disturbed by numbers of its own."""
    worlds = Worlds(scene, count, threads=threads)
    for number in range(count):
        stir(worlds._engine.arrays.state.numpy, number, number, scene.arrays.used)
    return worlds


def assert_same_bits(worlds: Worlds, number: int, lone: World) -> None:
    """One of many worlds is in the state of a world alone: coordinates, drives, contacts."""
    engine = worlds._engine
    used = lone.arrays.used
    compare(engine.arrays.state, number, lone.arrays.state, used)
    count = lone.contact_arrays.contact_count
    assert int(engine.contact_arrays.contacts.numpy["count_contacts"][number, THERE]) == count
    compare(engine.contact_arrays.contacts, number, lone.contact_arrays.contacts, {"contact": count})


def assert_all_same_bits(worlds: Worlds, alone: Iterable[World], steps: int) -> None:
    """Each of many worlds is in the state of the world alone after these steps, which this takes there."""
    for number, lone in enumerate(alone):
        lone.step(steps)
        assert_same_bits(worlds, number, lone)


def assert_as_stirred(worlds: Worlds, scene: World, steps: int, numbers: Iterable[int] | None = None) -> None:
    """Worlds of `stirred_worlds`, all or some, are in the state of `stirred` ones after these steps."""
    for number in range(worlds.count) if numbers is None else numbers:
        lone = stirred(scene, number)
        lone.step(steps)
        assert_same_bits(worlds, number, lone)


def compare(table: ArrayTable, number: int, alone: ArrayTable, rows: dict[str, int]) -> None:
    """The rows in use of one world of a table are those of the only world of another."""
    for name, array in table.numpy.items():
        axis = name.partition("_")[0]
        if axis in rows and name not in _NOT_STATE:
            ours, theirs = array[number, : rows[axis]], alone.numpy[name][0, : rows[axis]]
            np.testing.assert_array_equal(ours, theirs, err_msg=f"{name} of world {number}")
