"""Sensors and keyframes in many worlds, in snapshots and in files; noise, delay, period and cutoff."""

from __future__ import annotations

from pathlib import Path

import pytest
from numpy.testing import assert_array_equal

from carom import (
    Accelerometer,
    Body,
    Clock,
    Force,
    FramePosition,
    Gyro,
    JointPosition,
    Motor,
    SubtreeAngularMomentum,
    World,
    Worlds,
)
from carom.description.keyframe import BodyKeyframe
from carom.errors import DescriptionError

ARM = Path(__file__).parent / "data" / "arm.urdf"
H = 1e-3


def arm() -> Body:
    world = World(H)
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(ARM, (0.0, 0.0, 1.0), fixed_base=True)[0]
    body.add_site("imu", "tool")
    body.add_actuator("drive", Motor("shoulder"))
    body.joints.reset([0.3, 0.2], [1.0, -0.5])
    return body


def equipped() -> Body:
    body = arm()
    body.add_sensor("a", Accelerometer("imu", noise=0.1, bias=(1.0, 2.0, 3.0)))
    body.add_sensor("g", Gyro("imu", noise=0.01, delay=0.005))
    body.add_sensor("f", Force("imu"))
    body.add_sensor("q", JointPosition("elbow", period=0.004))
    body.add_sensor("m", SubtreeAngularMomentum("arm"))
    body.add_sensor("p", FramePosition(site="imu", reference_link="arm", cutoff=0.2))
    return body


def test_worlds_show_the_bits_of_lone_worlds() -> None:
    body = equipped()
    worlds = Worlds(body.world, 3)
    worlds.step(13)
    for number in range(3):
        lone = equipped()
        lone.world.parameters.sensor_seed = number
        lone.world.step(13)
        taken = worlds.extract(number).bodies[body.id]
        for name, shown in lone.sensors.read().items():
            assert_array_equal(worlds.bodies[body.name].sensors[name].read()[number], shown, err_msg=name)
            assert_array_equal(taken.sensors[name].read(), shown, err_msg=name)
    noisy = worlds.bodies[body.name].sensors["a"].read()
    assert (noisy[0] != noisy[1]).all()


def test_snapshots_copies_and_files_keep_what_sensors_remember(tmp_path: Path) -> None:
    body = equipped()
    body.world.step(7)
    copied = body.world.copy()
    body.world.save(tmp_path / "world.carom")
    loaded = World()
    loaded.load(tmp_path / "world.carom")
    state = body.world.snapshot()
    now = body.sensors.read()
    body.world.step(9)
    later = body.sensors.read()
    body.world.restore(state)
    for world in (body.world, copied, loaded):
        same = world.bodies[body.id]
        for name, shown in same.sensors.read().items():
            assert_array_equal(shown, now[name], err_msg=name)
        world.step(9)
        for name, shown in same.sensors.read().items():
            assert_array_equal(shown, later[name], err_msg=name)


def test_delay_and_period_hold_measurements_back() -> None:
    body = arm()
    body.add_sensor("late", Clock(delay=0.005))
    body.add_sensor("rare", Clock(period=0.004))
    body.add_sensor("bounded", Clock(cutoff=0.003, bias=-1.0))
    body.world.step(10)
    shown = {name: float(value[0]) for name, value in body.sensors.read().items()}
    assert shown == pytest.approx({"late": 0.005, "rare": 0.008, "bounded": -0.003})


def test_sensors_name_what_they_miss() -> None:
    body = arm()
    with pytest.raises(DescriptionError, match="no site 'nose'; it has 'imu'"):
        body.add_sensor("g", Gyro("nose"))
    with pytest.raises(DescriptionError, match="there is no joint 'knee'"):
        body.add_sensor("q", JointPosition("knee"))


def test_keyframes_reset_bodies_and_chosen_worlds() -> None:
    body = arm()
    world = body.world
    home = BodyKeyframe("home", 2.0, positions=(0.1, -0.2), velocities=(1.0, 2.0), controls=(0.5,))
    body.add_keyframe(home)
    with pytest.raises(DescriptionError, match="3 positions; the body needs 2"):
        body.add_keyframe(BodyKeyframe("bad", positions=(0.0, 0.0, 0.0)))
    worlds = Worlds(world, 3)
    worlds.step(5)
    worlds.reset("home", where=[False, True, False])
    assert_array_equal(worlds[body].joints.positions[1], [0.1, -0.2])
    assert_array_equal(worlds[body].actuators.controls[:, 0], [0.0, 0.5, 0.0])
    assert worlds.time[1] == 2.0 and worlds.time[0] < 0.01
    world.step(5)
    assert_array_equal(worlds[body].joints.positions[0], body.joints.positions)
    body.reset("home")
    assert_array_equal(body.joints.velocities, [1.0, 2.0])
    same = arm()
    same.joints.reset([0.1, -0.2], [1.0, 2.0])
    same.update_link_velocities()
    assert_array_equal(world.link_velocity, same.world.link_velocity)
    assert_array_equal(world.link_pose, same.world.link_pose)
    world.step(5)
    worlds.step(5)
    assert_array_equal(worlds[body].joints.positions[1], body.joints.positions)
    with pytest.raises(KeyError, match="no keyframe 'away'; it has 'home'"):
        body.reset("away")


def test_a_keyframe_of_one_body_leaves_the_sensors_of_others() -> None:
    bodies = [arm()]
    bodies.append(bodies[0].world.load(ARM, (0.0, 3.0, 1.0), fixed_base=True)[0])
    bodies[1].add_site("imu", "tool")
    for body in bodies:
        body.add_sensor("a", Accelerometer("imu"))
        body.add_keyframe(BodyKeyframe("home", positions=(0.1, -0.2)))
    bodies[0].world.step(5)
    before = [body.sensors["a"].read().copy() for body in bodies]
    bodies[0].reset("home")
    assert_array_equal(bodies[1].sensors["a"].read(), before[1])
    assert (bodies[0].sensors["a"].read() != before[0]).any()
    bodies[1].reset("home")
    assert (bodies[1].sensors["a"].read() != before[1]).any()


def test_specifications_bring_sites_sensors_and_keyframes() -> None:
    body = equipped()
    body.add_keyframe(BodyKeyframe("home", positions=(0.3, 0.2), velocities=(1.0, -0.5)))
    body.world.step(5)
    other = World(H)
    other.gravity = (0.0, 0.0, -9.81)
    same = other.load(body.spec, (0.0, 0.0, 1.0))
    same.reset("home")
    other.step(5)
    for name, shown in body.sensors.read().items():
        assert_array_equal(same.sensors[name].read(), shown, err_msg=name)
