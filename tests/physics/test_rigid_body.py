"""One rigid body without joints, against closed forms and an accurate integration."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.energy import momentum, order_of_convergence
from tests.physics.robots import coordinates, free_body, let_go

from carom import Body, World
from carom.description import Pose
from carom.model.body_spec import BASE, BodySpec, LinkSpec

DT = 1.0 / 240


def floating(spec: BodySpec, time_step: float = DT) -> Body:
    body = World(time_step, contact="bullet").load(spec)
    let_go(body)
    return body


def test_free_fall():
    body = floating(free_body())
    body.world.gravity = (0.5, 0.0, -9.81)
    body.set_base_velocity((1.0, 2.0, 3.0), (0.0, 0.0, 0.0))
    n = 100
    body.world.step(n)
    position, velocity = coordinates(body)
    gravity, thrown = np.array([0.5, 0.0, -9.81]), np.array([1.0, 2.0, 3.0])
    assert_allclose(velocity[3:], thrown + n * DT * gravity, rtol=1e-12)
    assert_allclose(position[:3], n * DT * thrown + n * (n + 1) / 2 * DT**2 * gravity, rtol=1e-12)
    assert_allclose(position[3:], [0.0, 0.0, 0.0, 1.0])


def test_constant_force_and_torque():
    body = floating(free_body(mass=2.0, inertia=(0.1, 0.2, 0.3)))
    n = 50
    for _ in range(n):
        body.world.link_force[0] = [1.0, 0.0, -2.0, 0.0, 0.0, 0.6]
        body.world.step()
    position, velocity = coordinates(body)
    assert_allclose(velocity, [0.0, 0.0, n * DT * 2.0, n * DT * 0.5, 0.0, -n * DT], rtol=1e-12, atol=1e-14)
    angle = n * (n + 1) / 2 * DT**2 * 2.0
    assert_allclose(position[3:], [0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)], atol=1e-12)


def test_forces_last_for_one_step():
    body = floating(free_body())
    body.world.link_force[0] = [1.0, 2.0, 3.0, 0.1, 0.2, 0.3]
    body.world.step()
    velocity = coordinates(body)[1].copy()
    np.testing.assert_array_equal(body.world.link_force, 0.0)
    body.world.step()
    assert_allclose(coordinates(body)[1][3:], velocity[3:], rtol=1e-15)


def test_linear_momentum_is_kept_to_rounding():
    body = floating(free_body(mass=3.0))
    body.set_base_velocity((0.3, -0.2, 0.1), (3.0, -4.0, 5.0))
    before = momentum(body)[:3]
    body.world.step(1000)
    assert_allclose(momentum(body)[:3], before, rtol=1e-13)


def true_rotation(inertia: np.ndarray, omega: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """Quaternion and body-axes angular velocity of a torque-free body, by a fourth-order method."""

    def rates(state: np.ndarray) -> np.ndarray:
        q, w = state[:4], state[4:]
        vector = 0.5 * (q[3] * w + np.cross(q[:3], w))
        return np.concatenate([vector, [-0.5 * q[:3] @ w], np.cross(inertia * w, w) / inertia])

    state = np.concatenate([[0.0, 0.0, 0.0, 1.0], omega])
    steps = 1000
    h = duration / steps
    for _ in range(steps):
        k1 = rates(state)
        k2 = rates(state + h / 2 * k1)
        k3 = rates(state + h / 2 * k2)
        k4 = rates(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state[:4] / np.linalg.norm(state[:4]), state[4:]


def test_tumbling_converges_to_the_torque_free_rotation():
    inertia, omega = np.array([0.1, 0.2, 0.27]), np.array([0.3, 4.0, 0.2])
    quaternion, spin = true_rotation(inertia, omega, 1.0)
    x, y, z = inertia.tolist()
    time_steps = [1.0 / 480, 1.0 / 960, 1.0 / 1920, 1.0 / 3840]
    orientation_errors, spin_errors = [], []
    for time_step in time_steps:
        body = floating(free_body(inertia=(x, y, z)), time_step)
        body.set_base_velocity((0.0, 0.0, 0.0), omega.tolist())
        body.world.step(round(1.0 / time_step))
        position, velocity = coordinates(body)
        axes = rotation(position[3:7])
        orientation_errors.append(float(np.abs(axes - rotation(quaternion)).max()))
        spin_errors.append(float(np.abs(axes.T @ velocity[:3] - spin).max()))
    assert order_of_convergence(time_steps, orientation_errors) == pytest.approx(1.0, abs=0.1)
    assert order_of_convergence(time_steps, spin_errors) == pytest.approx(1.0, abs=0.1)
    assert orientation_errors[-1] < 0.02


def test_steady_spin_about_a_principal_axis_is_exact():
    body = floating(free_body(inertia=(0.1, 0.2, 0.3)))
    body.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 7.0))
    body.world.step(240)
    position, velocity = coordinates(body)
    assert_allclose(velocity[:3], [0.0, 0.0, 7.0], atol=1e-13)
    assert_allclose(abs(position[3:] @ [0.0, 0.0, math.sin(3.5), math.cos(3.5)]), 1.0, rtol=1e-12)


@pytest.mark.parametrize("speed", [40.0, 48.0, 90.0])
def test_fast_spin_turns_less_than_it_should(speed):
    """Past an eighth of a turn per step Bullet bounds the angle, and so do we, but not the vector part."""
    time_step, eighth = 1.0 / 60, math.pi / 4
    body = floating(free_body(inertia=(0.2, 0.2, 0.2)), time_step)
    body.set_base_velocity((0.0, 0.0, 0.0), (speed, 0.0, 0.0))
    body.world.step()
    position, velocity = coordinates(body)
    half = speed * time_step / 2
    if 2 * half > eighth:
        half = math.atan(math.tan(eighth / 2) * 2 * half / eighth)
    assert_allclose(position[3:], [math.sin(half), 0.0, 0.0, math.cos(half)], atol=1e-14)
    assert velocity[0] == pytest.approx(speed)


@pytest.mark.parametrize("k", [0.04, 0.5])
def test_damping_takes_away_a_share_that_grows_with_speed(k):
    body = floating(free_body(mass=2.0, inertia=(0.3, 0.3, 0.3)))
    body.change_dynamics(BASE, linear_damping=k, angular_damping=2 * k)
    v, w = np.array([1.0, -2.0, 2.0]), np.array([0.0, 3.0, 4.0])
    body.set_base_velocity(v.tolist(), w.tolist())
    for _ in range(10):
        body.world.step()
        v = v * (1.0 - DT * (k + k * np.linalg.norm(v)))
        w = w * (1.0 - DT * 2 * k * (1.0 + np.linalg.norm(w)))
    velocity = coordinates(body)[1]
    assert_allclose(velocity[3:], v, rtol=1e-12)
    assert_allclose(velocity[:3], w, rtol=1e-12, atol=1e-14)


def test_damping_is_float32_0_04_at_first():
    body = World().load(free_body())
    body.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    body.world.step()
    assert coordinates(body)[1][3] == pytest.approx(1.0 - DT * 2 * float(np.float32(0.04)), rel=1e-15)


@pytest.mark.parametrize(("bound", "row"), [(None, 5), (None, 0), (7.5, 4), (7.5, 2)])
def test_every_velocity_coordinate_is_clamped(bound, row):
    body = World().load(free_body())
    if bound is not None:
        body.change_dynamics(BASE, max_joint_velocity=bound)
    for sign in (1.0, -1.0):
        wrench = np.zeros(6)
        # Rates are angular before linear, wrenches the other way round.
        wrench[(row + 3) % 6] = sign * 1e9
        body.world.link_force[0] = wrench
        body.world.step()
        assert coordinates(body)[1][row] == sign * (bound or 100.0)


def test_the_inertial_frame_moves_not_the_link_frame():
    """Base coordinates are those of the centre of mass, wherever the link frame is."""
    turned = Pose((0.1, 0.2, 0.3), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    link = LinkSpec("base", mass=1.0, inertia=(0.1, 0.2, 0.3), inertial_frame=turned)
    body = World().load(BodySpec("offset", link), position=(1.0, 0.0, 0.0))
    assert_allclose(coordinates(body)[0][:7], [1.1, 0.2, 0.3, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)])
    let_go(body)
    # A quarter turn takes the principal x axis, the one of moment 0.1, to the world's y.
    body.world.link_force[0] = [0.0, 0.0, 0.0, 0.0, 0.1, 0.0]
    body.world.step()
    assert_allclose(coordinates(body)[1], [0.0, DT, 0.0, 0.0, 0.0, 0.0], atol=1e-16)


def test_a_massless_body_stands_still():
    body = World().load(free_body(mass=0.0, inertia=(0.0, 0.0, 0.0)))
    body.world.gravity = (0.0, 0.0, -9.81)
    body.world.link_force[0] = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    body.world.step(3)
    np.testing.assert_array_equal(coordinates(body)[1], 0.0)
