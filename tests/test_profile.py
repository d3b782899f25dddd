"""World.profile: the same steps, and where their time goes."""

import numpy as np
import pytest
from tests.physics.contact_scenes import add_box, add_floor, earth

from carom import World
from carom.profiling import profile
from carom.scene.core.profile import SOFT_STAGE, STAGES


def scene(substeps: int, *, touching: bool) -> World:
    world = earth(substeps=substeps)
    if touching:
        add_floor(world)
    for i in range(5):
        add_box(world, (0.05 * i, 0.0, 0.11 + 0.2 * i))
    return world


@pytest.mark.parametrize("substeps", [0, 3])
@pytest.mark.parametrize("touching", [True, False], ids=["on the floor", "in the air"])
def test_a_profiled_world_moves_as_any_other(substeps: int, touching: bool) -> None:
    profiled, other = scene(substeps, touching=touching), scene(substeps, touching=touching)
    profile(profiled, 30)
    profiled.step(10)
    other.step(40)
    assert profiled.time == pytest.approx(40 / 240)
    np.testing.assert_allclose(profiled.position, other.position, rtol=0, atol=1e-12)
    assert profiled.contact_arrays.contact_count == other.contact_arrays.contact_count


def test_every_stage_is_named_and_takes_its_time() -> None:
    seconds = profile(scene(0, touching=True), 5)
    assert tuple(seconds) == STAGES
    assert all(value > 0.0 for value in seconds.values())


def test_soft_bodies_are_a_stage_of_their_own() -> None:
    world = scene(0, touching=True)
    world.load_cloth(cells=(3, 3))
    seconds = profile(world, 5)
    assert tuple(seconds) == (*STAGES, SOFT_STAGE)
    assert seconds[SOFT_STAGE] > 0.0


def test_a_world_of_one_body_detects_no_collisions() -> None:
    world = earth()
    add_box(world, (0.0, 0.0, 1.0))
    seconds = profile(world, 5)
    assert seconds["narrow phase"] == 0.0
    assert seconds["free motion"] > 0.0
