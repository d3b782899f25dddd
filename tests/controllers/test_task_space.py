"""Computed torque, operational space control, impedance control, gravity compensation, on the Panda."""

from typing import Any

import numpy as np
import pytest
from tests.algorithms.moving_robots import load, moved
from tests.controllers.robots import HAND, READY, panda

from carom import World
from carom.algorithms import forward_dynamics
from carom.controllers import (
    ComputedTorque,
    ImpedanceControl,
    OperationalSpaceControl,
    gravity_compensation,
)

STEP = 1e-3


def power(matrix: np.ndarray, exponent: float) -> np.ndarray:
    """A power of a symmetric positive matrix."""
    values, vectors = np.linalg.eigh(matrix)
    return (vectors * values**exponent) @ vectors.T


def test_gravity_compensation_holds_the_arm():
    world, robot = panda()
    for _ in range(200):
        robot.joints.set_torques(gravity_compensation(robot))
        world.step()
    assert robot.joints.positions == pytest.approx(READY, abs=1e-9)
    robot.joints.set_torques(np.zeros(9))
    world.step(200)
    assert np.abs(robot.joints.positions - READY).max() > 0.01


def test_control_needs_a_fixed_base():
    world = World()
    with pytest.raises(ValueError, match="is free"):
        gravity_compensation(world.add_box((0.1, 0.1, 0.1), mass=1.0))


def test_computed_torque_follows_a_path_exactly():
    world, robot = panda()
    control = ComputedTorque(robot, frequency=30.0)
    phases = np.arange(9) / 3
    sizes = np.array([0.4] * 7 + [0.005] * 2)

    def path(k: int) -> np.ndarray:
        # It starts at rest, with its first two places at the start.
        time = max(k, 0) * STEP
        return np.array(READY) + sizes * (1 - np.cos(3 * time)) * np.cos(phases)

    worst = 0.0
    for k in range(1500):
        velocity = (path(k) - path(k - 1)) / STEP
        acceleration = (path(k + 1) - 2 * path(k) + path(k - 1)) / STEP**2
        robot.joints.set_torques(control.compute(path(k), velocity, acceleration))
        world.step()
        worst = max(worst, np.abs(robot.joints.positions - path(k + 1)).max())
    assert worst < 1e-6
    assert np.abs(robot.joints.positions - READY).max() > 0.1


def test_computed_torque_has_decoupled_critically_damped_errors():
    _, robot = panda()
    control = ComputedTorque(robot, frequency=12.0)
    error = np.array([0.1, -0.05, 0.2, 0.1, -0.3, 0.1, 0.2, 0.0, 0.01])
    rates = np.linspace(-0.5, 0.5, 9)
    robot.joints.reset(READY - error, rates)
    torques = control.compute(READY)
    found = forward_dynamics(robot, robot.joints.positions, rates, torques)
    assert found == pytest.approx(144.0 * error - 24.0 * rates, abs=1e-8)


@pytest.mark.parametrize("point", [(0.0, 0.0, 0.0), (0.02, -0.05, 0.1)])
def test_operational_space_control_has_the_designed_dynamics(point):
    _, robot = panda()
    rates = np.linspace(-0.4, 0.6, 9)
    robot.joints.reset(READY, rates)
    control = OperationalSpaceControl(robot, HAND, frequency=(10, 11, 12, 13, 14, 15), point=point)
    goal = control.pose[0] + np.array([0.05, -0.1, 0.02])
    turned = np.array([0.1, 0.0, 0.0, 1.0])
    torques = control.compute(goal, turned, velocity=(0.1,) * 6, acceleration=(0.3,) * 6)
    task = control.dynamics()
    joints = forward_dynamics(robot, robot.joints.positions, rates, torques)
    error = control.error(goal, turned)
    omega = np.arange(10.0, 16.0)
    wanted = 0.3 + 2 * omega * (0.1 - task.velocity) + omega**2 * error
    assert task.jacobian @ joints + task.bias == pytest.approx(wanted, abs=1e-7)


def test_bias_and_jacobian_of_a_point_are_derivatives_of_its_motion():
    _, robot = panda()
    rates = np.linspace(-0.4, 0.6, 9)
    control = OperationalSpaceControl(robot, HAND, point=(0.02, -0.05, 0.1))

    def at(time: float) -> tuple[np.ndarray, np.ndarray]:
        robot.joints.reset(np.array(READY) + time * rates, rates)
        return control.pose[0], control.dynamics().velocity

    (before, slow), (after, fast) = at(-1e-6), at(1e-6)
    at(0.0)
    task = control.dynamics()
    assert (after - before) / 2e-6 == pytest.approx(task.velocity[:3], abs=1e-7)
    assert (fast - slow) / 2e-6 == pytest.approx(task.bias, abs=1e-7)


def test_the_hand_goes_to_its_goal_as_a_critically_damped_mass():
    world, robot = panda()
    control = OperationalSpaceControl(robot, HAND, frequency=8.0)
    start, turn = control.pose
    goal, time = start + np.array([0.1, 0.05, -0.1]), 0.0
    for _ in range(1000):
        robot.joints.set_torques(control.compute(goal, turn))
        world.step()
        time += STEP
        share = (1 + 8 * time) * np.exp(-8 * time)
        assert control.pose[0] - goal == pytest.approx(share * (start - goal), abs=1.5e-3)
    assert control.error(goal, turn) == pytest.approx(np.zeros(6), abs=1e-3)


def test_the_null_space_pulls_to_the_posture_and_leaves_the_hand():
    world, robot = panda()
    # The light fingers must not reach their stops.
    frequency = np.array([10.0] * 7 + [200.0] * 2)
    control = OperationalSpaceControl(robot, HAND, frequency=20.0, posture_frequency=frequency)
    goal, turn = control.pose
    control.posture = np.array(READY) + 0.5 * np.eye(9)[0]
    for _ in range(2000):
        robot.joints.set_torques(control.compute(goal, turn))
        world.step()
    assert control.error(goal, turn) == pytest.approx(np.zeros(6), abs=1e-5)
    assert np.abs(robot.joints.positions - READY)[:7].max() > 0.1


def test_a_push_meets_the_stiffness_that_was_asked_for():
    world, robot = panda()
    stiffness = np.diag([300.0, 500.0, 800.0])
    stiffness[0, 1] = stiffness[1, 0] = 100.0
    control = ImpedanceControl(robot, HAND, stiffness=stiffness, orientation=False)
    goal, _ = control.pose
    push = np.array([3.0, -4.0, 5.0])
    for _ in range(3000):
        robot.joints.set_torques(control.compute(goal))
        robot.links[HAND].apply_force(push, control.pose[0])
        world.step()
    assert np.abs(robot.joints.velocities).max() < 1e-6
    assert stiffness @ (control.pose[0] - goal) == pytest.approx(push, rel=1e-6)


def test_impedance_has_the_inertia_of_the_robot_and_critical_damping():
    _, robot = panda()
    rates = np.linspace(-0.4, 0.6, 9)
    robot.joints.reset(READY, rates)
    control = ImpedanceControl(robot, HAND)
    position, orientation = control.pose
    goal = position + np.array([0.02, 0.01, -0.03])
    task = control.dynamics()
    torques = control.compute(goal, orientation)
    joints = forward_dynamics(robot, robot.joints.positions, rates, torques)
    spring = np.diag([400.0] * 3 + [20.0] * 3) @ control.error(goal, orientation)
    damped = spring - task.inertia @ (task.jacobian @ joints + task.bias)
    # D = 2 √Λ √(√Λ⁻¹ K √Λ⁻¹) √Λ.
    root = power(task.inertia, 0.5)
    inverse = np.linalg.inv(root)
    damping = 2.0 * root @ power(inverse @ np.diag([400.0] * 3 + [20.0] * 3) @ inverse, 0.5) @ root
    assert damped == pytest.approx(damping @ task.velocity, abs=1e-7)
    # All modes of Λ ẍ + D ẋ + K x = 0 are double: s = -ω twice.
    whole = np.block(
        [
            [np.zeros((6, 6)), np.eye(6)],
            [
                -np.linalg.solve(task.inertia, np.diag([400.0] * 3 + [20.0] * 3)),
                -np.linalg.solve(task.inertia, damping),
            ],
        ]
    )
    roots = np.linalg.eigvals(whole)
    assert np.abs(roots.imag).max() < 1e-4 * np.abs(roots).max()


def test_an_orientation_is_a_quaternion_of_any_norm_but_0():
    _, robot = panda()
    control = OperationalSpaceControl(robot, HAND)
    position, orientation = control.pose
    wanted = np.array([0.3, -0.1, 0.2, 0.9])
    plain = control.compute(position, wanted / np.linalg.norm(wanted))
    for factor in (2.0, -0.5):
        assert control.compute(position, factor * wanted) == pytest.approx(plain, abs=1e-9)
    still = control.compute(position, orientation)
    assert np.abs(still - gravity_compensation(robot)).max() < 1e-9
    with pytest.raises(ValueError, match="orientation must be a quaternion that is not 0"):
        control.compute(position, np.zeros(4))


def formula(control: OperationalSpaceControl | ImpedanceControl, pull: np.ndarray, force: np.ndarray):
    """Torques of a force on the task and of accelerations of the posture, (n,), from matrices."""
    task = control.dynamics()
    return task.jacobian.T @ force + task.null_space @ (task.mass_matrix @ pull) + task.bias_forces


@pytest.mark.parametrize("orientation", [True, False])
def test_torques_are_those_of_the_formula_where_the_arm_is_stretched(orientation):
    _, robot = panda()
    rates = np.linspace(-0.4, 0.6, 9)
    # All axes but two are in one plane.
    robot.joints.reset(np.zeros(9), rates)
    control = OperationalSpaceControl(robot, HAND, frequency=8.0, orientation=orientation, posture=READY)
    goal = control.pose[0] + np.array([0.05, -0.1, 0.02])
    rows = 6 if orientation else 3
    turned = np.array([0.1, 0.0, 0.0, 1.0]) if orientation else None
    torques = control.compute(goal, turned, velocity=(0.1,) * 6, acceleration=(0.3,) * 6)
    task = control.dynamics()
    mobility = task.jacobian @ np.linalg.solve(task.mass_matrix, task.jacobian.T)
    assert task.inertia == pytest.approx(np.linalg.pinv(mobility, 1e-6, hermitian=True), rel=1e-6, abs=1e-6)
    motion = 0.3 + 16.0 * (0.1 - task.velocity) + 64.0 * control.error(goal, turned)
    pull = 25.0 * (np.array(READY) - robot.joints.positions) - 10.0 * rates
    wanted = formula(control, pull, task.inertia @ (motion - task.bias))
    assert len(task.bias) == rows
    assert torques == pytest.approx(wanted, rel=1e-9, abs=1e-7)


def test_masses_that_change_count():
    _, robot = panda()
    control = OperationalSpaceControl(robot, HAND)
    position, orientation = control.pose
    before = control.compute(position, orientation)
    robot.change_dynamics(HAND, mass=3.0)
    assert control.compute(position, orientation) == pytest.approx(gravity_compensation(robot), abs=1e-9)
    assert np.abs(control.compute(position, orientation) - before).max() > 1.0


def test_targets_are_numbers_or_six_of_them():
    _, robot = panda()
    control = ImpedanceControl(robot, HAND)
    position, orientation = control.pose
    each = control.compute(position, orientation, velocity=[0.1] * 6, force=(2.0,) * 6)
    same: dict[str, Any] = {"velocity": 0.1, "force": 2.0}
    assert control.compute(position, orientation, **same) == pytest.approx(each, abs=0.0)
    for wrong, name in (
        ({"position": (0.0, 0.0)}, "position must have shape"),
        ({"position": (0.0, np.inf, 0.0)}, "position must be finite"),
        ({"position": (0.0, 0.0, 0.0, 1.0), "orientation": (0.0, 0.0, 0.0)}, "orientation must have shape"),
        ({"velocity": (0.0, np.nan, 0.0, 0.0, 0.0, 0.0)}, "velocity must be finite"),
        ({"force": "many"}, "force"),
    ):
        with pytest.raises(ValueError, match=name):
            control.compute(**{"position": position, **wrong})
    control.posture = np.full(9, np.nan)
    with pytest.raises(ValueError, match="posture must be finite"):
        control.compute(position)


def test_a_tree_with_all_kinds_of_joints_is_pulled_to_its_posture():
    world = World()
    robot = load(world, "fixed tree")
    control = OperationalSpaceControl(robot, robot.joint_count - 1, posture_frequency=4.0)
    # The first joint is planar: it slides, and does not turn.
    change = np.linspace(0.0, 0.3, sum(robot.velocity_count))
    control.posture = moved(robot, robot.joints.positions, change)
    task = control.dynamics()
    wanted = formula(control, 16.0 * change, task.inertia @ -task.bias)
    position, orientation = control.pose
    assert control.compute(position, orientation) == pytest.approx(wanted, rel=1e-6, abs=1e-6)
