"""A step that fails leaves the whole state as it was before, on whatever it runs."""

import math

import numpy as np
import pytest
from tests.engine.failing import everything, full_scene, spoil

from carom import Worlds
from carom.errors import SimulationError, SimulationWarning


@pytest.mark.parametrize("substeps", [0, 3])
def test_a_failed_step_leaves_the_state_as_it_was(substeps: int) -> None:
    world, last = full_scene(substeps)
    before = everything(world)
    world.link_force[last.first_link] = math.nan
    with pytest.raises(SimulationError):
        world.step()
    after = everything(world)
    for name, array in before.items():
        np.testing.assert_array_equal(after[name], array, err_msg=name)


@pytest.mark.parametrize("substeps", [0, 3])
def test_after_a_failed_step_the_world_goes_on_as_if_there_had_been_none(substeps: int) -> None:
    (world, last), (spared, _) = full_scene(substeps), full_scene(substeps)
    world.link_force[last.first_link] = math.nan
    with pytest.raises(SimulationError):
        world.step()
    world.step(20)
    spared.step(20)
    expected = everything(spared)
    for name, array in everything(world).items():
        np.testing.assert_array_equal(array, expected[name], err_msg=name)


def test_a_world_that_is_halted_has_the_state_of_before() -> None:
    world, last = full_scene()
    worlds = Worlds(world, 3, threads=2)
    spoil(worlds, last)
    with pytest.warns(SimulationWarning, match="world 1 is halted"):
        worlds.step(3)
    halted, expected = everything(worlds.extract(1)), everything(world)
    for name, array in expected.items():
        np.testing.assert_array_equal(halted[name], array, err_msg=name)
