"""Logs that can be read: PyBullet's, CSV, NumPy's archives, arrays, logs of worlds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.identification.robots import STEP, load

import pybullet as p
import pybullet_data
from carom import identify
from carom.identification.measurements import Measurements
from carom.identification.reading import measurements_of

_CONTROL = "physics.slider_to_cart.torque"


def _swing(world, robot, count=40):
    robot.joints.reset([0.0, 0.4])
    rows = []
    for row in range(count):
        torque = [np.sin(0.2 * row), 0.0]
        rows.append((world.time, robot.joints.positions, robot.joints.velocities, torque))
        robot.joints.set_torques(torque)
        world.step()
    time, positions, velocities, torques = (np.array(column) for column in zip(*rows, strict=True))
    return {"time": time, "positions": positions, "velocities": velocities, "torques": torques}


def _same(found, log):
    for name in ("positions", "velocities", "torques"):
        assert getattr(found, name) == pytest.approx(log[name], abs=1e-12)
    assert found.time_step == pytest.approx(STEP)


def test_csv_archives_and_arrays_are_the_same(tmp_path):
    world, robot = load("cartpole.urdf")
    log = _swing(world, robot)
    command = np.cos(log["time"])
    _same(measurements_of(log, robot), log)
    arrays: dict[str, Any] = {**log, _CONTROL: command}
    np.savez(tmp_path / "log.npz", **arrays)
    found = measurements_of(tmp_path / "log.npz", robot)
    _same(found, log)
    assert found.controls[_CONTROL] == pytest.approx(command)
    names = ["time", _CONTROL]
    columns = [log["time"], command]
    for end, kind in (("position", "positions"), ("velocity", "velocities"), ("torque", "torques")):
        for place, joint in enumerate(("slider_to_cart", "cart_to_pole")):
            names.append(f"{joint}.{end}")
            columns.append(log[kind][:, place])
    path = tmp_path / "log.csv"
    rows = [",".join(map(repr, row)) for row in np.stack(columns, axis=1).tolist()]
    path.write_text("\n".join([",".join(names), *rows]), encoding="utf-8")
    found = measurements_of(path, robot)
    _same(found, log)
    assert found.controls[_CONTROL] == pytest.approx(command)


def test_a_log_of_pybullet_is_read_and_its_torques_belong_to_the_state_before(tmp_path):
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81, physicsClientId=client)
    path = str(tmp_path / "state.bin")
    robot = p.loadURDF(pybullet_data.getDataPath() + "/cartpole.urdf", physicsClientId=client)
    for joint in (0, 1):
        p.setJointMotorControl2(robot, joint, p.VELOCITY_CONTROL, force=0, physicsClientId=client)
    p.resetJointState(robot, 1, 0.4, physicsClientId=client)
    flags = p.STATE_LOG_JOINT_USER_TORQUES
    number = p.startStateLogging(
        p.STATE_LOGGING_GENERIC_ROBOT, path, [robot], maxLogDof=4, logFlags=flags, physicsClientId=client
    )
    rows = []
    for row in range(240):
        torque = 3.0 * np.sin(0.05 * row)
        p.setJointMotorControl2(robot, 0, p.TORQUE_CONTROL, force=torque, physicsClientId=client)
        before = [p.getJointState(robot, joint, physicsClientId=client)[0] for joint in (0, 1)]
        rows.append((torque, before))
        p.stepSimulation(physicsClientId=client)
    p.stopStateLogging(number, physicsClientId=client)
    p.disconnect(client)
    world, model = load("cartpole.urdf")
    found = measurements_of(path, model)
    assert found.time_step == pytest.approx(STEP, rel=1e-5)
    assert len(found) == 240
    assert found.positions[:-1] == pytest.approx(np.array([row[1] for row in rows[1:]]), abs=1e-6)
    assert found.torques is not None
    assert found.torques[:-1, 0] == pytest.approx(np.array([row[0] for row in rows[1:]]), abs=1e-5)
    assert np.isnan(found.torques[-1]).all()
    # The mass of the pole and the cart are known from the torques, though single precision and air blur them.
    start = "physics.pole.inertial"
    model.change_dynamics("pole", mass=0.3, inertia=(1.0, 1.0, 1.0))
    result = identify(path, world, [start])
    assert result.values[f"{start}.moment.z"] == pytest.approx(0.05, abs=0.02)
    damaged = tmp_path / "damaged.bin"
    with open(path, "rb") as file:
        damaged.write_bytes(file.read().replace(b"\xaa\xbb", b"\xaa\xbc", 3))
    with pytest.raises(ValueError, match="damaged"):
        measurements_of(damaged, model)


def test_a_log_of_a_world_is_read():
    world, robot = load("cartpole.urdf")
    with world.log("position", "velocity") as log:
        _swing(world, robot)
    found = measurements_of(log, robot)
    assert found.positions[-1] == pytest.approx(robot.joints.positions)
    assert found.velocities is not None
    assert found.velocities[-1] == pytest.approx(robot.joints.velocities)


def test_what_cannot_be_read_is_named(tmp_path):
    _, robot = load("cartpole.urdf")
    for name, text, message in (
        ("log.bin", "no log", "STATE_LOGGING_GENERIC_ROBOT"),
        ("log.csv", "time,slider_to_cart.position\n0,0\n", "cart_to_pole.position"),
        ("words.csv", "time\nnow\n", "numbers"),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
        with pytest.raises(ValueError, match=message):
            measurements_of(tmp_path / name, robot)
    places = np.zeros((5, 2))
    with pytest.raises(ValueError, match="equal intervals"):
        Measurements.of([0.0, 0.1, 0.2, 0.4, 0.5], places)
    with pytest.raises(ValueError, match="shape"):
        Measurements.of(STEP, places, torques=np.zeros((5, 3)))
    with pytest.raises(ValueError, match="3 joints"):
        measurements_of({"time": STEP, "positions": np.zeros((5, 3))}, robot)
    with pytest.raises(ValueError, match="'speed'"):
        measurements_of({"time": STEP, "positions": places, "speed": places}, robot)


def test_controls_of_a_log_and_those_beside_it_are_together():
    world, robot = load("cartpole.urdf")
    first, second = np.arange(10.0), np.arange(10.0) ** 2
    log: dict[str, Any] = {**_swing(world, robot, 10), "controls": {_CONTROL: first, "gravity": second}}
    found = measurements_of(log, robot, {"gravity": first, "friction": second}).controls
    assert found.keys() == {_CONTROL, "gravity", "friction"}
    assert np.array_equal(found["gravity"], first) and np.array_equal(found["friction"], second)
