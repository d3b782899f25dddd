"""Steps linearised at states of one's choice, and vector-Jacobian products."""

import gc
import weakref
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tests.joints.test_actuators import all_kinds
from tests.linearization.scenes import ASSETS, excite, motors_off, new_world, set_velocity, tighten

from carom import World
from carom.layouts.codes import UNFILTERED
from carom.linearization.stepping import Copies

CONTROLS = ["torques", "target_positions", "actuators"]


def driven_panda() -> World:
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/franka_panda/panda.urdf", fixed_base=True, as_pybullet=False)
    excite(body, share=0.2)
    for joint in body.joints.movable[:4]:
        joint.set_position_target(0.3, gain=0.01, max_force=1e4)
    body.joints.movable[5].set_position_target(-1.0, max_force=0.5)
    return world


def sliding_box() -> World:
    world = new_world(plane=True)
    box = world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.5))
    world.step(5)
    set_velocity(box, 0.0, 0.0, 0.0, 1.0, 0.4, 0.0)
    return world


def actuated() -> World:
    body = all_kinds()
    tighten(body.world)
    body.actuators.controls = [0.3, 0.0, 0.3, 1.5, 1.0, 0.4, 0.4]
    return body.world


def falling_humanoid() -> World:
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/humanoid/humanoid.urdf", (0.0, 0.0, 4.0))
    excite(body)
    motors_off(body)
    return world


def contents(world: World) -> dict[str, bytes]:
    """All that a world has in its tables."""
    tables = world.arrays.state, world.arrays.model, world.contact_arrays.contacts
    return {f"{k}.{name}": it.tobytes() for k, table in enumerate(tables) for name, it in table.numpy.items()}


@pytest.mark.parametrize("make", [driven_panda, sliding_box, falling_humanoid, actuated])
@pytest.mark.parametrize("steps", [1, 3])
def test_a_vector_jacobian_product_is_that_of_the_matrices(make: Any, steps: int):
    world = make()
    chosen: dict[str, Any] = {"parameters": ["masses", "damping"], "steps": steps}
    step = world.linearize(CONTROLS, **chosen)
    cotangent = np.random.default_rng(2).normal(size=len(step.states))
    before = contents(world)
    found = world.step_vjp(cotangent, CONTROLS, **chosen)
    assert contents(world) == before
    for part, matrix in zip(found, (step.A, step.B, step.E), strict=True):
        scale = max(1.0, np.abs(matrix).max(initial=0.0))
        assert_allclose(part, cotangent @ matrix, rtol=0, atol=1e-10 * scale)


@pytest.mark.parametrize("method", ["exact", "differences"])
@pytest.mark.parametrize("make", [driven_panda, falling_humanoid, actuated])
def test_a_step_can_be_linearised_at_another_state_and_other_controls(make: Any, method: str):
    world = make()
    other = world.copy()
    rng = np.random.default_rng(5)
    body = other.bodies[min(other.bodies.keys())]
    excite(body, seed=7, share=0.3)
    state, model = other.arrays.state.numpy, other.arrays.model.numpy
    active = np.flatnonzero(model["actuator_dynamics"][: len(body.spec.actuators)] != UNFILTERED)
    state["actuator_activation"][0, active] = rng.uniform(0.1, 0.2, len(active))
    torques = rng.uniform(-0.2, 0.2, sum(body.velocity_count))
    other.joint_torque[6 : 6 + len(torques)] = torques
    controls = ["torques", "actuators"]
    body.actuators.controls = 0.5 * np.array(body.actuators.controls)
    values = np.concatenate([torques, body.actuators.controls])
    plain, before = world.linearize(controls), contents(world)
    found = world.linearize(
        controls,
        method=method,
        positions=other.position,
        velocities=other.velocity,
        activations=state["actuator_activation"][0, active],
        control_values=values,
        outputs=lambda after: after.position,
    )
    assert contents(world) == before
    wanted = other.linearize(controls, method=method, outputs=lambda after: after.position)
    for name in "ABCD":
        assert_array_equal(getattr(found, name), getattr(wanted, name))
    assert np.abs(found.A - plain.A).max() > 1e-6


def test_wrong_lengths_are_named():
    world = driven_panda()
    for name in ("positions", "velocities", "activations", "control_values"):
        start: dict[str, Any] = {name: [0.0, 1.0, 2.0]}
        with pytest.raises(ValueError, match=f"{name} must have shape"):
            world.linearize(**start)
    with pytest.raises(ValueError, match="velocities"):
        world.linearize(velocities=np.full(len(world.velocity), np.nan))
    with pytest.raises(ValueError, match="cotangent must have shape"):
        world.step_vjp(np.zeros(3))
    with pytest.raises(ValueError, match="steps must be at least 1"):
        world.step_vjp(np.zeros(18), steps=0)


def test_what_is_kept_for_the_next_call_does_not_keep_a_world():
    world = driven_panda()
    world.linearize()
    gone = weakref.ref(world)
    del world
    gc.collect()
    assert gone() is None


def test_the_next_call_makes_no_other_copy_of_the_world(monkeypatch: pytest.MonkeyPatch):
    world = driven_panda()
    before = world.linearize()

    def refuse(*_: Any) -> None:
        raise AssertionError("a second copy")

    monkeypatch.setattr(Copies, "__init__", refuse)
    assert_array_equal(world.linearize().A, before.A)


def test_a_body_in_place_of_names_is_refused_with_what_to_give():
    world = sliding_box()
    body: Any = next(iter(world))
    with pytest.raises(TypeError, match=r"list of kinds or full names, such as \['torques'\]"):
        world.linearize(body)
    with pytest.raises(TypeError, match=r"such as \['masses'\]"):
        world.linearize(parameters=body)
