"""One step of the engine against the articulated-body algorithm in NumPy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import Motion, forward_dynamics
from tests.physics.robots import MOVING_TYPES, coordinates, let_go, put_in_motion, random_tree

from carom import Body, World
from carom.model.body_spec import BodySpec

GRAVITY = (0.3, -0.7, -9.81)


def body_in_motion(spec: BodySpec, rng: np.random.Generator, speed: float = 1.0) -> Body:
    """A body in a world whose step is 1 s long: velocities change by the acceleration."""
    world = World(time_step=1.0)
    world.gravity = GRAVITY
    body = world.load(spec)
    let_go(body)
    put_in_motion(body, rng, speed)
    return body


def unforced(body: Body) -> Motion:
    """Acceleration that the reference gives a body under gravity alone."""
    position, velocity = coordinates(body)
    no_torque, no_wrench = np.zeros(len(velocity) - 6), np.zeros((1 + body.joint_count, 6))
    return forward_dynamics(body.spec, position, velocity, no_torque, np.array(GRAVITY), no_wrench)


def measured(body: Body) -> Motion:
    """Acceleration of a body over one step."""
    before = coordinates(body)[1].copy()
    body.world.step()
    change = coordinates(body)[1] - before
    return Motion(change[:3], change[3:6], change[6:])


def assert_same_motion(found: Motion, expected: Motion, tolerance: float) -> None:
    scale = max(1.0, *(np.abs(part).max(initial=0.0) for part in vars(expected).values()))
    for name, part in vars(expected).items():
        assert_allclose(getattr(found, name), part, rtol=0, atol=tolerance * scale, err_msg=name)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
@pytest.mark.parametrize("is_chain", [True, False], ids=["chain", "branching"])
@pytest.mark.parametrize("seed", range(4))
def test_accelerations_under_all_forces_at_once(seed, is_chain, fixed_base):
    rng = np.random.default_rng(seed)
    spec = random_tree(seed, 3 + 4 * seed, fixed_base=fixed_base, is_chain=is_chain)
    body = body_in_motion(spec, rng)
    position, velocity = coordinates(body)
    torque = rng.normal(size=len(velocity) - 6)
    wrench = rng.normal(size=(1 + body.joint_count, 6))
    body.world.joint_torque[body.first_velocity + 6 :][: len(torque)] = torque
    body.world.link_force[body.first_link :][: len(wrench)] = wrench
    expected = forward_dynamics(spec, position, velocity, torque, np.array(GRAVITY), wrench)
    assert_same_motion(measured(body), expected, 1e-10)


@pytest.mark.parametrize("joint_type", MOVING_TYPES, ids=lambda joint_type: joint_type.value)
def test_accelerations_of_chains_of_one_kind_of_joint(joint_type):
    rng = np.random.default_rng(5)
    spec = random_tree(5, 6, fixed_base=False, joint_types=[joint_type], is_chain=True)
    body = body_in_motion(spec, rng)
    expected = unforced(body)
    assert_same_motion(measured(body), expected, 1e-11)


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
def test_accelerations_of_a_large_tree(fixed_base):
    rng = np.random.default_rng(6)
    spec = random_tree(6, 80, fixed_base=fixed_base)
    body = body_in_motion(spec, rng, speed=0.3)
    expected = unforced(body)
    assert_same_motion(measured(body), expected, 1e-9)


def test_two_bodies_do_not_disturb_each_other():
    rng = np.random.default_rng(7)
    specs = [random_tree(7, 5, fixed_base=False), random_tree(8, 6, fixed_base=True)]
    world = World(time_step=1.0)
    world.gravity = GRAVITY
    bodies = [world.load(spec) for spec in specs]
    expected = []
    for body in bodies:
        let_go(body)
        put_in_motion(body, rng)
        expected.append(unforced(body))
    before = world.velocity.copy()
    world.step()
    for body, motion in zip(bodies, expected, strict=True):
        first, count = body.first_velocity, 6 + sum(body.velocity_count)
        change = (world.velocity - before)[first : first + count]
        assert_same_motion(Motion(change[:3], change[3:6], change[6:]), motion, 1e-10)
