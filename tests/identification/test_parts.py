"""Derivatives by inertial parameters, physical coordinates, inertial frames that move, smoothing."""

from __future__ import annotations

import numpy as np
import pytest
from tests.identification.robots import STEP, disturb, load, panda

from carom.algorithms import inertial_parameters, inverse_dynamics, joint_torque_regressor
from carom.description.tendon import PathKind, PathPart, TendonSpec
from carom.identification.link_inertia import set_link_inertia
from carom.identification.measurements import Measurements
from carom.identification.motion import motion_of
from carom.identification.pseudo_inertia import PseudoInertia, centre_and_inertia
from carom.identification.smoothing import chosen_cutoff, smoothed


def _parameters(rng):
    arm = rng.normal(size=(30, 3)) * (0.1, 0.2, 0.3) + (0.1, -0.2, 0.3)
    masses = rng.uniform(0.1, 0.2, 30)
    inertia = np.sum(
        [m * (x @ x * np.eye(3) - np.outer(x, x)) for m, x in zip(masses, arm, strict=True)], axis=0
    )
    six = inertia[(0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)]
    return np.array([masses.sum(), *(masses @ arm), *six])


def test_distances_of_inertia_are_convex_and_grow_without_bound():
    rng = np.random.default_rng(1)
    start, other = _parameters(rng), _parameters(rng)
    link = PseudoInertia(start)
    value, gradient, matrix = link.distance(start)
    assert value == pytest.approx(0.0, abs=1e-9)
    assert np.abs(gradient * link.scale).max() < 1e-9
    assert np.linalg.eigvalsh(matrix * np.outer(link.scale, link.scale))[0] > 0.0
    room = link.room(start, start - other)
    far = [link.distance(start + share * room * (start - other))[0] for share in (0.5, 0.9, 0.999, 0.999999)]
    assert 0.0 < far[0] < far[1] < far[2] < far[3] - 5.0
    mass, _, inertia = centre_and_inertia(start + 0.999999 * room * (start - other))
    a, b, c = np.linalg.eigvalsh(inertia)
    assert mass > 0.0 and a > 0.0 and a + b >= c * (1.0 - 1e-9)
    assert link.room(start, other) == np.inf


def test_derivatives_of_distances_are_central_differences():
    rng = np.random.default_rng(2)
    link, at = PseudoInertia(_parameters(rng)), _parameters(rng)
    _, gradient, matrix = link.distance(at)
    steps = 1e-6 * np.diag(link.scale)
    near = [(link.distance(at + d)[0] - link.distance(at - d)[0]) / 2e-6 for d in steps]
    assert gradient * link.scale == pytest.approx(near, rel=1e-6, abs=1e-6)
    rows = np.array([(link.distance(at + d)[1] - link.distance(at - d)[1]) / 2e-6 for d in steps])
    scaled = matrix * link.scale[:, None]
    assert np.abs(rows - scaled).max() < 1e-5 * np.abs(scaled).max()


def test_what_is_not_physical_is_no_start():
    with pytest.raises(ValueError, match="density"):
        PseudoInertia(np.array([1.0, 0.0, 0.0, 0.0, 0.1, 0.0, 0.1, 0.0, 0.0, 0.3]))


def test_a_link_with_another_inertia_moves_as_the_regressor_says():
    rng = np.random.default_rng(3)
    _, robot = panda()
    disturb(robot, rng)
    q, v, a = ([*rng.uniform(-1.0, 1.0, 7), 0.01, 0.02] for _ in range(3))
    forces = joint_torque_regressor(robot, q, v, a) @ inertial_parameters(robot).ravel()
    armature = np.array([joint.armature for joint in robot.joints.movable]) * a
    assert inverse_dynamics(robot, q, v, a) == pytest.approx(forces + armature, abs=1e-10)


def test_shapes_and_link_frames_stay_where_they_are():
    world, robot = panda()
    robot.joints.reset([0.1, 0.2, 0.3, -1.0, 0.5, 1.0, 0.2, 0.01, 0.01])
    other = robot.links["panda_link4"]
    before = [(link.pose.position, link.pose.orientation) for link in robot.links]
    hits = world.queries().cast_ray((2.0, 0.05, 0.4), (-2.0, 0.05, 0.4))
    set_link_inertia(robot, other.index, 1.5, (0.02, -0.05, 0.1), np.diag([0.02, 0.03, 0.04]) + 0.004)
    for link, (position, orientation) in zip(robot.links, before, strict=True):
        assert link.pose.position == pytest.approx(position, abs=1e-12)
        assert abs(link.pose.orientation @ orientation) == pytest.approx(1.0, abs=1e-12)
    after = world.queries().cast_ray((2.0, 0.05, 0.4), (-2.0, 0.05, 0.4))
    assert hits is not None and after is not None
    assert after.position == pytest.approx(hits.position, abs=1e-9)
    found = inertial_parameters(robot)[1 + other.index]
    assert found[:4] == pytest.approx([1.5, 0.03, -0.075, 0.15])


def test_what_is_fixed_to_an_inertial_frame_is_not_moved():
    _, robot = load("cartpole.urdf")
    with pytest.raises(NotImplementedError, match="no link -1"):
        set_link_inertia(robot, -1, 1.0, (0.0, 0.0, 0.5), np.eye(3))
    robot.add_tendon(TendonSpec("cord", (PathPart(PathKind.JOINT, 0, size=0.5),), stiffness=2.0))
    with pytest.raises(NotImplementedError, match="tendons"):
        set_link_inertia(robot, robot.links["pole"].index, 1.0, (0.0, 0.0, 0.5), np.eye(3))
    with pytest.raises(ValueError, match="positive"):
        _, other = load("cartpole.urdf")
        set_link_inertia(other, other.links["pole"].index, -1.0, (0.0, 0.0, 0.5), np.eye(3))


def test_steps_have_derivatives_by_inertial_parameters():
    world, robot = load("cartpole.urdf")
    robot.joints.movable[0].friction_loss = 0.4
    robot.joints.reset([0.0, 0.5], [0.3, 2.0])
    link = robot.links["pole"].index
    exact = world.linearize([], parameters=["inertial_parameters"], steps=3)
    columns = [k for k, name in enumerate(exact.parameters) if ".pole." in name]
    start = inertial_parameters(robot)[1 + link]

    def state(change):
        copy = world.copy()
        body = copy.bodies[robot.id]
        set_link_inertia(body, link, *centre_and_inertia(start + change))
        for _ in range(3):
            copy.step()
        return np.concatenate([body.joints.positions, body.joints.velocities])

    near = np.array([(state(d) - state(-d)) / 2e-6 for d in 1e-6 * np.eye(10)]).T
    assert np.abs(near).max() > 1e-3
    assert np.abs(exact.E[:, columns] - near).max() < 1e-7
    with pytest.raises(NotImplementedError, match="exact"):
        world.linearize(parameters=["inertial_parameters"], method="differences")
    robot.change_dynamics(-1, linear_damping=0.1)
    with pytest.raises(NotImplementedError, match="air damping"):
        world.linearize(parameters=["inertial_parameters"])


def test_smoothing_relates_velocities_and_accelerations_as_steps_do():
    rng = np.random.default_rng(4)
    acceleration = np.polynomial.Polynomial([1.0, -2.0, 3.0])(STEP * np.arange(60))
    velocity = np.concatenate([[0.5], 0.5 + STEP * np.cumsum(acceleration)])[:60]
    position = STEP * np.cumsum(velocity)
    place, rate, change = smoothed(position[:, None], STEP, 8, 4)
    own = slice(8, 52)
    assert place[:, 0] == pytest.approx(position[own], abs=1e-12)
    assert rate[:, 0] == pytest.approx(velocity[own], abs=1e-9)
    assert change[:, 0] == pytest.approx(acceleration[own], abs=1e-6)
    noisy = position + rng.normal(0.0, 1e-5, 60)
    off = {}
    for window in (12, 4):
        found = smoothed(noisy[:, None], STEP, window, 4)[2][:, 0]
        off[window] = np.std(found - acceleration[window : 60 - window])
    assert off[12] < 0.2 * off[4]


def test_a_motion_is_as_measured_or_filtered_as_asked():
    _, robot = load("cartpole.urdf")
    time = STEP * np.arange(60)
    waves = np.stack([np.sin(9.0 * time), np.cos(7.0 * time)], axis=1)
    positions, velocities, accelerations = 0.1 * waves, 2.0 * waves, 3.0 * waves
    measured = Measurements.of(time, positions, torques=waves, velocities=velocities)
    asked = motion_of(measured, robot, 6.0, None, 3)
    assert asked.cutoff == 6.0
    chosen = motion_of(measured, robot, None, None, 3)
    assert chosen.cutoff == chosen_cutoff(positions, STEP)
    # Velocities alone do not tell accelerations, so both are found from positions.
    assert np.abs(chosen.velocities - velocities).max() > 0.5
    both = Measurements.of(time, positions, torques=waves, velocities=velocities, accelerations=accelerations)
    whole = motion_of(both, robot, None, None, 3)
    assert whole.cutoff is None
    assert np.array_equal(whole.velocities, velocities)
    assert np.array_equal(whole.accelerations, accelerations)
    part = Measurements.of(time, positions, torques=waves, accelerations=accelerations)
    partly = motion_of(part, robot, 6.0, None, 3)
    assert np.array_equal(partly.accelerations, accelerations)
    assert np.array_equal(partly.velocities, asked.velocities)
