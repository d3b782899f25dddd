"""Motions that tell the parameters of a robot apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.identification.robots import load, panda

from carom import Body, World, identify
from carom.algorithms import inverse_dynamics
from carom.identification import ExcitingTrajectory, exciting_trajectory

TWO_JOINTS = """<mujoco><option timestep="0.004"/>
<default><geom contype="0" conaffinity="0"/></default>
<worldbody><body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" limited="true" range="-90 45"
 damping="0.4" frictionloss="0.3"/><geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="2"/>
<body name="lower" pos="0.4 0 0"><joint name="elbow" axis="0 0 1" damping="0.2"/>
<geom type="capsule" fromto="0 0 0 0.3 0.05 0" size="0.03" mass="1"/></body></body></worldbody></mujoco>"""
FITTED = ["upper.upper.inertial", "upper.lower.inertial", "damping", "joint_friction"]


@pytest.fixture(scope="module")
def arm() -> tuple[World, Body]:
    world = World()
    world.load(TWO_JOINTS)
    return world, world["upper"]


@pytest.fixture(scope="module")
def trajectory(arm: tuple[World, Body]) -> ExcitingTrajectory:
    return exciting_trajectory(arm[0], FITTED, period=8.0, velocity=[2.0, 3.0], acceleration=8.0, share=0.8)


def test_it_keeps_all_limits_and_uses_one_of_each_joint(trajectory: ExcitingTrajectory):
    rows = trajectory.sampled(1e-3)
    middle, room = np.radians([-22.5, 0.0]), 0.8 * np.radians([67.5, 180.0])
    used = np.array(
        [
            np.abs(rows["positions"] - middle).max(axis=0) / room,
            np.abs(rows["velocities"]).max(axis=0) / [2.0, 3.0],
            np.abs(rows["accelerations"]).max(axis=0) / 8.0,
        ]
    )
    assert (used <= 1.005).all()
    assert (used.max(axis=0) > 0.99).all()


def test_each_period_begins_and_ends_at_rest(trajectory: ExcitingTrajectory):
    for time in (0.0, 8.0):
        place, velocity, acceleration = trajectory.at(time)
        assert place == pytest.approx(trajectory.at(0.0)[0])
        assert np.abs([velocity, acceleration]).max() < 1e-12


def test_velocities_and_accelerations_are_derivatives(trajectory: ExcitingTrajectory):
    time = np.linspace(0.1, 7.9, 50)
    late, early, now = (trajectory.at(time + change) for change in (1e-5, -1e-5, 0.0))
    for order in (0, 1):
        assert (late[order] - early[order]) / 2e-5 == pytest.approx(now[order + 1], abs=1e-7)


def test_it_tells_more_than_motions_at_random(arm: tuple[World, Body], trajectory: ExcitingTrajectory):
    def best(**options: Any) -> ExcitingTrajectory:
        limits: dict[str, Any] = {"period": 8.0, "velocity": [2.0, 3.0], "acceleration": 8.0, "share": 0.8}
        return exciting_trajectory(arm[0], FITTED, **limits, **options)

    assert trajectory.least > 1.05 * best(rounds=0, starts=30).least
    assert best().least == trajectory.least
    assert best(seed=1).least != trajectory.least


def test_a_log_of_it_is_identified(arm: tuple[World, Body], trajectory: ExcitingTrajectory):
    world, body = arm
    rng = np.random.default_rng(0)
    rows = trajectory.sampled(world.time_step)
    torques = np.array(
        [
            inverse_dynamics(body, place, velocity, acceleration)
            for place, velocity, acceleration in zip(
                rows["positions"], rows["velocities"], rows["accelerations"], strict=True
            )
        ]
    )
    after = rows["velocities"] + world.time_step * rows["accelerations"]
    torques += after * [0.4, 0.2] + np.sign(after) * [0.3, 0.0]
    torques += rng.normal(0.0, 0.01, torques.shape)
    other = world.copy()
    for joint in other["upper"].joints:
        joint.damping *= 1.5
    result = identify({**rows, "torques": torques}, other, FITTED)
    assert result.values["upper.shoulder.damping"] == pytest.approx(0.4, abs=0.02)
    assert result.values["upper.elbow.damping"] == pytest.approx(0.2, abs=0.02)
    assert result.values["upper.shoulder.joint_friction"] == pytest.approx(0.3, abs=0.02)


def test_motions_in_which_the_robot_touches_something_are_refused():
    world, robot = load("franka_panda/panda.urdf")
    world.add_plane((0.0, 0.0, 0.3))
    chosen = [f"{robot.name}.panda_link7.inertial"]
    with pytest.raises(ValueError, match=r"in each of the 2 motions 'panda_\w+' of .*touches"):
        exciting_trajectory(world, chosen, body=robot, starts=2, rounds=0)
    assert exciting_trajectory(world, chosen, body=robot, starts=1, rounds=0, collides=True).least > 0.0


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"harmonics": 2}, "harmonics must be at least 3"),
        ({"period": 0.0}, "period must be positive"),
        ({"share": 1.5}, "share between 0 and 1"),
        ({"velocity": [1.0, 2.0, 3.0]}, "one for each of 2 joints"),
        ({"acceleration": -1.0}, "acceleration must be positive"),
        ({"velocity": float("nan")}, "velocity"),
    ],
)
def test_arguments_out_of_range_are_refused(arm: tuple[World, Body], wrong: dict, message: str):
    with pytest.raises(ValueError, match=message):
        exciting_trajectory(arm[0], FITTED, **wrong)


@pytest.mark.long
def test_the_panda_is_excited_within_its_limits():
    world, robot = panda()
    names = [f"{robot.name}.panda_link{number}.inertial" for number in range(1, 8)]
    found = exciting_trajectory(world, names, starts=2, rounds=20, collides=True)
    rows = found.sampled(1e-2)
    lower, upper = robot.joints.limits
    assert (rows["positions"] > lower).all() and (rows["positions"] < upper).all()
    assert found.least > 1.5 * exciting_trajectory(world, names, starts=8, rounds=0, collides=True).least
