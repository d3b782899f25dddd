"""Sensors that are not read cost no work of Python in a step, and worlds with them keep their lanes."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tests.linearization.scenes import ASSETS

from carom import Accelerometer, Body, Force, FrameLinearAcceleration, Gyro, Torque, World, Worlds
from carom.layouts.programs import LANES
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.reading import reading


def robot(**noise: Any) -> tuple[World, Body]:
    """A moving quadruped with sensors of forces and accelerations at a foot."""
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{ASSETS}/plane.urdf")
    body = world.load_urdf(f"{ASSETS}/laikago/laikago.urdf", (0.0, 0.0, 0.5))
    body.add_site("foot", body.joint_count - 1)
    for name, kind in (("force", Force), ("torque", Torque), ("imu", Accelerometer), ("gyro", Gyro)):
        body.add_sensor(name, kind(site="foot", **noise))
    body.add_sensor("world", FrameLinearAcceleration(link=body.spec.base.name, cutoff=9.0))
    return world, body


def test_no_python_runs_in_a_step():
    world, body = robot()
    assert not world.observers
    body.add_sensor("late", Gyro(site="foot", delay=0.01))
    assert len(world.observers) == 1


def test_worlds_with_sensors_keep_their_lanes():
    world, body = robot()
    worlds = Worlds(world, 2 * LANES, threads=1)
    worlds.step(5)
    assert worlds._engine.steps_in_lanes == 10
    world.step(5)
    for name, values in worlds.bodies[1].sensors.read().items():
        assert_array_equal(values, np.tile(body.sensors[name].read(), (worlds.count, 1)), name)


@pytest.mark.parametrize("noise", [0.0, 0.1])
def test_accelerations_stay_those_of_the_step(noise: float):
    world, body = robot(noise=noise)
    assert not body.sensors["imu"].read().any() or noise
    world.step(3)
    shown = body.sensors.read()
    body.joints.movable[0].reset(0.3, 1.0)
    world.gravity = (1.0, 0.0, 0.0)
    for name in ("imu", "world", "force", "torque"):
        assert_array_equal(body.sensors[name].read(), shown[name], name)
    kept = world.snapshot()
    world.step()
    assert np.abs(body.sensors["imu"].read() - shown["imu"]).max() > 1e-3
    world.restore(kept)
    assert_array_equal(body.sensors["imu"].read(), shown["imu"])
    assert_array_equal(world.copy().bodies[body.id].sensors["imu"].read(), shown["imu"])


def test_an_accelerometer_shows_the_change_of_velocities():
    world, body = robot()
    world.step(4)
    base = body.first_velocity + 3
    before = world.velocity[base : base + 3].copy()
    world.step()
    wanted = (world.velocity[base : base + 3] - before) / world.parameters.time_step + [0.0, 0.0, 9.81]
    body.add_sensor("base", FrameLinearAcceleration(inertial_frame=body.spec.base.name))
    assert_allclose(body.sensors["base"].read(), wanted, rtol=1e-12)


def test_all_read_together_are_those_read_alone():
    world, body = robot(bias=0.1)
    for name in ("gyro", "imu"):
        body.add_sensor(f"short {name}", (Gyro if name == "gyro" else Accelerometer)(site="foot", cutoff=0.5))
    world.step(5)
    shown = body.sensors.read()
    for sensor in body.sensors:
        wanted = reading(LoneSource(world), body, sensor.index)[0]
        assert_allclose(shown[sensor.name], wanted, rtol=1e-12, atol=1e-12, err_msg=sensor.name)
