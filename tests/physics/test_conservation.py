"""Energy and momentum without friction: errors fall with the time step at the integrator's order."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.energy import energy, momentum, order_of_convergence
from tests.physics.robots import coordinates, joint_coordinates, let_go, pendulum, put_in_motion, random_tree

from carom import Body, World
from carom.description import JointType
from carom.layouts.codes import MOTOR_VELOCITY
from carom.model.body_spec import BodySpec

TIME_STEPS = [1.0 / 240, 1.0 / 480, 1.0 / 960, 1.0 / 1920]


def released(spec: BodySpec, time_step: float, angles: list[float], rates: list[float]) -> Body:
    world = World(time_step)
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(spec)
    let_go(body)
    position, velocity = joint_coordinates(body)
    position[:], velocity[:] = angles, rates
    return body


@pytest.mark.parametrize(
    ("angles", "rates"), [([2.0], [0.5]), ([1.2, -0.7], [0.3, 1.0])], ids=["pendulum", "double pendulum"]
)
def test_energy_error_of_pendulums_is_of_first_order(angles, rates):
    worst = []
    for time_step in TIME_STEPS:
        body = released(pendulum(len(angles)), time_step, angles, rates)
        start = energy(body)
        drift = 0.0
        for _ in range(round(0.5 / time_step / 4)):
            body.world.step(4)
            drift = max(drift, abs(energy(body) - start))
        worst.append(drift)
    assert order_of_convergence(TIME_STEPS, worst) == pytest.approx(1.0, abs=0.1)
    assert worst[-1] < 0.02


def test_energy_of_a_pendulum_does_not_drift_away():
    """Semi-implicit Euler is symplectic: its energy error stays within the same bounds for ever."""
    body = released(pendulum(), 1.0 / 240, [2.0], [0.0])
    start = energy(body)
    worst = []
    for _period in range(6):
        errors = []
        for _ in range(120):
            body.world.step(8)
            errors.append(abs(energy(body) - start))
        worst.append(max(errors))
    assert max(worst[1:]) < 1.05 * worst[0]
    assert worst[0] < 0.02 * 2.0 * 9.81


def test_path_of_a_pendulum_converges_to_the_true_one():
    """Against a fourth-order solution of q̈ = -(m g l / I) sin q."""

    def acceleration(q: float) -> float:
        return -2.0 * 9.81 * 0.5 / (2.0 / 3.0) * np.sin(q)

    q, v, h = 2.0, 0.5, 1.0 / 4000
    for _ in range(2000):
        k1, l1 = v, acceleration(q)
        k2, l2 = v + h / 2 * l1, acceleration(q + h / 2 * k1)
        k3, l3 = v + h / 2 * l2, acceleration(q + h / 2 * k2)
        k4, l4 = v + h * l3, acceleration(q + h * k3)
        q, v = q + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), v + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4)
    errors = []
    for time_step in TIME_STEPS:
        body = released(pendulum(), time_step, [2.0], [0.5])
        body.world.step(round(0.5 / time_step))
        errors.append(abs(joint_coordinates(body)[0][0] - q))
    assert order_of_convergence(TIME_STEPS, errors) == pytest.approx(1.0, abs=0.05)


def floating_tree(time_step: float) -> Body:
    world = World(time_step)
    types = (JointType.REVOLUTE, JointType.PRISMATIC, JointType.SPHERICAL, JointType.PLANAR)
    body = world.load(random_tree(3, 8, fixed_base=False, joint_types=types))
    let_go(body)
    put_in_motion(body, np.random.default_rng(3))
    return body


def test_momentum_of_a_free_floating_tree_is_kept_at_the_order_of_the_integrator():
    errors = []
    for time_step in TIME_STEPS:
        body = floating_tree(time_step)
        start = momentum(body)
        body.world.step(round(0.1 / time_step))
        errors.append(np.abs(momentum(body) - start).reshape(2, 3).max(axis=1))
    linear, angular = np.transpose(errors)
    assert order_of_convergence(TIME_STEPS, linear) == pytest.approx(1.0, abs=0.15)
    assert order_of_convergence(TIME_STEPS, angular) == pytest.approx(1.0, abs=0.15)


def test_gravity_adds_its_impulse():
    body = floating_tree(1.0 / 1920)
    body.world.gravity = (1.0, -2.0, -9.81)
    position, velocity = coordinates(body)
    velocity[:] = 0.0
    placed = position.copy()
    body.world.step()
    position[:] = placed
    mass = sum(body.dynamics(link).mass for link in range(-1, body.joint_count))
    assert_allclose(momentum(body)[:3], mass * np.array([1.0, -2.0, -9.81]) / 1920, rtol=1e-12)


def test_motors_give_no_momentum():
    """Impulses inside a floating tree at rest move its parts, not the whole."""
    world = World()
    body = world.load(random_tree(4, 9, fixed_base=False))
    put_in_motion(body, np.random.default_rng(4), speed=0.0)
    position, velocity = coordinates(body)
    world.motor[body.first_velocity + 6 : body.first_velocity + len(velocity), MOTOR_VELOCITY] = 1.0
    placed = position.copy()
    world.step()
    assert np.abs(velocity[6:]).max() > 0.1
    position[:] = placed
    assert_allclose(momentum(body), 0.0, atol=1e-12)
