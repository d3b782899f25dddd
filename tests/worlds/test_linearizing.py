"""A step of many worlds linearised, beside lone worlds in the same state."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.linearization.scenes import ASSETS, excite, new_world, set_velocity

from carom import World, Worlds

CHOSEN: dict[str, Any] = {"parameters": ["masses", "friction"]}
CONTROLS = ["torques", "target_positions"]


def arm_and_box() -> World:
    """An arm with motors, and a box that slides on a plane."""
    world = new_world(plane=True)
    arm = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", (2.0, 0.0, 0.0), fixed_base=True)
    excite(arm, share=0.2)
    arm.joints.movable[1].set_position_target(0.3, gain=0.01, max_force=1e4)
    box = world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.5))
    world.step(5)
    set_velocity(box, 0.0, 0.0, 0.0, 1.0, 0.4, 0.0)
    return world


@pytest.fixture(scope="module", params=[1, 2])
def worlds(request: pytest.FixtureRequest) -> Worlds:
    worlds = Worlds(arm_and_box(), 5, threads=request.param)
    # One box is in the air, so that world has fewer rows; and parameters differ.
    engine = worlds._engine
    state = engine.arrays.state.numpy
    box = worlds.bodies[2]._body
    state["position"][3, box.first_position + 2] += 1.0
    arm = worlds.bodies[1]._body
    rng = np.random.default_rng(3)
    links = slice(arm.first_link + 1, arm.first_link + 1 + arm.joint_count)
    masses = engine.parameter("model", "link_mass", links)
    engine.set_parameter("model", "link_mass", links, masses * rng.uniform(0.8, 1.2, masses.shape))
    gravity = worlds.gravity.copy()
    gravity[:, 2] = np.linspace(-9.0, -10.0, 5)
    worlds.gravity = gravity
    return worlds


def test_each_world_is_linearised_as_a_lone_world(worlds: Worlds):
    for _ in range(2):
        found = worlds.linearize(CONTROLS, **CHOSEN)
        for number in range(worlds.count):
            lone = worlds.extract(number).linearize(CONTROLS, **CHOSEN)
            for name in ("A", "B", "E"):
                assert_array_equal(getattr(found, name)[number], getattr(lone, name), name)
            assert found.rows[number] == lone.rows
            assert (found.states, found.controls) == (lone.states, lone.controls)
        assert len(found.rows[3]) < len(found.rows[0])
        # The copy that is kept follows them.
        worlds.step()


def test_worlds_do_not_change(worlds: Worlds):
    tables = worlds._engine.arrays.state, worlds._engine.contact_arrays.contacts
    before = [(array, array.copy()) for table in tables for array in table.numpy.values()]
    worlds.linearize()
    assert all(array.tobytes() == copy.tobytes() for array, copy in before)


def test_some_worlds_and_cotangents(worlds: Worlds):
    whole = worlds.linearize(CONTROLS, **CHOSEN)
    some = worlds.linearize(CONTROLS, **CHOSEN, where=[3, 1])
    assert_array_equal(some.A, whole.A[[3, 1]])
    cotangents = np.random.default_rng(1).normal(size=(2, len(whole.states)))
    found = worlds.step_vjp(cotangents, CONTROLS, **CHOSEN, where=[3, 1])
    for part, matrices in zip(found, (some.A, some.B, some.E), strict=True):
        wanted = np.einsum("ni,nij->nj", cotangents, matrices)
        assert np.abs(part - wanted).max() < 1e-10 * max(1.0, np.abs(matrices).max())
    none = worlds.linearize(CONTROLS, **CHOSEN, where=[])
    for part, matrices in zip((none.A, none.B, none.E), (whole.A, whole.B, whole.E), strict=True):
        assert part.shape == (0, *matrices.shape[1:])


def test_mistakes_are_named():
    worlds = Worlds(arm_and_box(), 2, threads=1)
    with pytest.raises(ValueError, match="cotangents must have shape"):
        worlds.step_vjp(np.zeros(3))
    with pytest.raises(ValueError, match="smoothing must be at least 0"):
        worlds.linearize(smoothing=-1.0)
    worlds.halted[1] = True
    with pytest.raises(ValueError, match="world 1 is halted"):
        worlds.linearize()
    assert worlds.linearize(where=[0]).A.shape[0] == 1
