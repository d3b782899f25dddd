"""States of worlds as arrays of bytes, with more room for contacts than a state has."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World, Worlds
from carom.worlds.algorithms.packed import Packing


def test_states_come_back_from_arrays_with_room_to_spare():
    world = World(gravity=(0.0, 0.0, -9.81))
    world.add_plane()
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1))
    worlds = Worlds(world, 3)
    worlds.step(5)
    saved = worlds.snapshot()
    number = saved.contacts["contact_shapes"].shape[1]
    packing = Packing(saved, {"contact": number + 7, "overlap": 20})
    packed = packing.pack(saved)
    assert packed.shape == (3, packing.size)
    worlds.step(20)
    there = worlds[box].base_inertial_poses.copy()
    worlds.restore(packing.unpack(packed))
    worlds.step(20)
    assert np.array_equal(worlds[box].base_inertial_poses, there)
    with pytest.raises(ValueError, match=f"has {number} contacts, and the memory has room for 1"):
        Packing(saved, {"contact": 1, "overlap": 20}).pack(saved)
