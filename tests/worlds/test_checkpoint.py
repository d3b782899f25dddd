"""`Worlds.checkpoint` and `resume`: states and parameters of all worlds."""

import numpy as np
import pytest
from tests.physics.contact_scenes import add_ball, add_box, add_floor, earth

from carom import Worlds
from carom.errors import SimulationWarning


def scene(*, boxes: int = 2, count: int = 4) -> Worlds:
    """Boxes that fall on each other."""
    world = earth()
    add_floor(world)
    for number in range(boxes):
        add_box(world, (0.02 * number, 0.0, 0.12 + 0.25 * number))
    return Worlds(world, count)


def varied(worlds: Worlds) -> None:
    """Let the worlds differ in what can differ."""
    kinds = np.arange(worlds.count)
    worlds.gravity = np.stack([0.0 * kinds, 0.0 * kinds, -9.0 - kinds], axis=1)
    worlds[1].change_dynamics(-1, mass=1.0 + kinds, lateral_friction=0.1 * (1 + kinds))
    worlds[2].set_base_velocities((0.5, 0.0, 0.0, 0.0, 0.0, 1.0), where=[1, 2])
    worlds.sensor_seeds[:] = 10 + kinds


def test_new_copies_continue_bit_for_bit():
    worlds, others = scene(), scene()
    varied(worlds)
    worlds.step(60)
    saved = worlds.checkpoint()
    # Parameters that only the others have set are as in the checkpoint, too.
    others[2].change_dynamics(-1, restitution=0.9, where=[0])
    others.resume(saved)
    assert (others.sensor_seeds == worlds.sensor_seeds).all()
    assert (others.time == worlds.time).all()
    for _ in range(60):
        worlds.step()
        others.step()
        for body in (1, 2):
            assert (others[body].base_inertial_poses == worlds[body].base_inertial_poses).all()
            assert (others[body].base_velocities == worlds[body].base_velocities).all()
    assert len(np.unique(worlds[2].base_inertial_poses[:, 0])) == 4


def test_it_is_a_copy():
    worlds = scene()
    saved = worlds.checkpoint()
    before = saved["times"].copy()
    worlds.step(10)
    worlds.gravity = 0.0, 0.0, 1.0
    assert (saved["times"] == before).all()
    worlds.resume(saved)
    assert (worlds.gravity[:, 2] == -9.81).all()
    assert (worlds.time == before).all()


def test_worlds_that_were_halted_are_and_their_time_step_is_back():
    worlds, others = scene(), scene()
    worlds.time_step = 0.001
    worlds[1].set_base_velocities((0.0, 0.0, 1.0, 0.0, 0.0, 0.0))
    worlds[1].base_inertial_poses[2, 2] = np.nan
    worlds[1].links[-1].apply_force((1.0, 0.0, 0.0))
    with pytest.warns(SimulationWarning):
        worlds.step()
    others.resume(worlds.checkpoint())
    assert others.halted.tolist() == worlds.halted.tolist() == [False, False, True, False]
    assert others.time_step == 0.001


def test_checkpoints_of_other_worlds_are_refused_and_nothing_changes():
    worlds = scene()
    before = worlds.gravity
    with pytest.raises(ValueError, match="a checkpoint of 3 worlds; there are 4"):
        worlds.resume(scene(count=3).checkpoint())
    with pytest.raises(ValueError, match="other bodies"):
        worlds.resume(scene(boxes=3).checkpoint())
    world = earth()
    for number in range(3):
        add_ball(world, (0.0, 0.0, float(number)))
    with pytest.raises(ValueError, match="other bodies"):
        worlds.resume(Worlds(world, 4).checkpoint())
    assert (worlds.gravity == before).all()
