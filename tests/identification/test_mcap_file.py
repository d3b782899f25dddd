"""Joint states of MCAP files, written by `mcap` and `mcap_ros2`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.identification.robots import load

from carom import Body, identify
from carom.identification import read_mcap

pytest.importorskip("mcap", reason="for developers: `make .venv/dev`")
mcap_writer = pytest.importorskip("mcap.writer")
JOINTS = ("slider_to_cart", "cart_to_pole")
TIME = 0.01 * np.arange(50)
PLACES = np.stack([np.sin(TIME), np.cos(3.0 * TIME)], axis=1)
ROS2 = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""


@pytest.fixture(scope="module")
def robot() -> Body:
    return load("cartpole.urdf")[1]


def state(row: int, names: tuple[str, ...] = JOINTS, **others: Any) -> dict[str, Any]:
    return {"name": list(names), "position": PLACES[row, : len(names)].tolist(), **others}


def write_json(file: Path, topics: dict[str, list[tuple[float, dict[str, Any]]]]) -> Path:
    with file.open("wb") as stream:
        writer = mcap_writer.Writer(stream)
        writer.start()
        for topic, messages in topics.items():
            schema = writer.register_schema("JointState", "jsonschema", b'{"type": "object"}')
            channel = writer.register_channel(topic, "json", schema)
            for time, message in messages:
                stamp = round(1e9 * time)
                writer.add_message(channel, stamp, json.dumps(message).encode(), stamp)
        writer.finish()
    return file


def write_ros2(file: Path, reverse: bool = False) -> Path:
    writer_of_ros = pytest.importorskip("mcap_ros2.writer")
    with file.open("wb") as stream:
        writer = writer_of_ros.Writer(stream)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", ROS2)
        order = [1, 0] if reverse else [0, 1]
        for row, time in enumerate(TIME):
            stamp = {"sec": 100, "nanosec": round(1e9 * time)}
            message = {
                "header": {"stamp": stamp, "frame_id": ""},
                "name": [JOINTS[k] for k in order],
                "position": PLACES[row, order].tolist(),
                "velocity": [],
                "effort": [float(k) for k in order],
            }
            writer.write_message("/joint_states", schema, message, log_time=7)
        writer.finish()
    return file


@pytest.mark.parametrize("reverse", [False, True])
def test_joint_states_of_ros_2_are_read_by_the_names_of_joints(tmp_path: Path, robot: Body, reverse: bool):
    read = read_mcap(write_ros2(tmp_path / "log.mcap", reverse), robot)
    assert read.positions == pytest.approx(PLACES, abs=1e-6)
    assert read.time_step == pytest.approx(0.01, rel=1e-6)
    assert read.velocities is None
    assert read.torques == pytest.approx(np.tile([0.0, 1.0], (50, 1)))


def test_what_came_at_unequal_intervals_is_taken_at_equal_ones(tmp_path: Path, robot: Body):
    late = TIME + 0.002 * np.sin(np.arange(50.0))
    rows = [{"name": list(JOINTS), "position": [2.0 * time, -time]} for time in late.tolist()]
    messages = [*zip(late.tolist(), rows, strict=True)]
    # Messages that came twice, and not in their order.
    read = read_mcap(write_json(tmp_path / "log.mcap", {"/js": [*messages[::-1], messages[3]]}), robot)
    time = read.time_step * np.arange(50) + late[0]
    assert read.positions == pytest.approx(np.stack([2.0 * time, -time], axis=1), abs=1e-8)


def test_topics_without_the_joints_are_left_out_and_several_need_a_choice(tmp_path: Path, robot: Body):
    both = [(time, state(row)) for row, time in enumerate(TIME.tolist())]
    gripper = [(time, {"name": ["finger"], "position": [0.0]}) for time in TIME.tolist()]
    other = [(time, {"text": "no state"}) for time in TIME.tolist()]
    file = write_json(tmp_path / "one.mcap", {"/gripper": gripper, "/js": both, "/log": other})
    assert read_mcap(file, robot).positions == pytest.approx(PLACES)
    file = write_json(tmp_path / "two.mcap", {"/js": both, "/copy": both[::2]})
    with pytest.raises(ValueError, match="'/js', '/copy' have states of all joints: say which by topic"):
        read_mcap(file, robot)
    assert len(read_mcap(file, robot, "/copy")) == 25
    with pytest.raises(ValueError, match="no topic '/none' has states of all joints"):
        read_mcap(file, robot, "/none")


def test_missing_joints_are_named(tmp_path: Path, robot: Body):
    file = write_json(
        tmp_path / "log.mcap", {"/js": [(0.0, state(0, JOINTS[:1])), (0.1, state(1, JOINTS[:1]))]}
    )
    with pytest.raises(ValueError, match=r"missing: cart_to_pole \('/js' has slider_to_cart\)"):
        read_mcap(file, robot)


def test_what_is_no_mcap_file_is_refused(tmp_path: Path, robot: Body):
    whole = write_json(tmp_path / "log.mcap", {"/js": [(0.0, state(0)), (0.1, state(1))]}).read_bytes()
    for name, data in {
        "text": b"hello",
        "empty": b"",
        "damaged": whole[:60] + b"\xff" * 40 + whole[100:],
    }.items():
        file = tmp_path / f"{name}.mcap"
        file.write_bytes(data)
        with pytest.raises(ValueError, match=r"no MCAP file, or is damaged|no topic"):
            read_mcap(file, robot)


def test_identify_takes_the_path_of_one(tmp_path: Path):
    world, robot = load("cartpole.urdf")
    robot.joints.movable[1].reset(0.5)
    messages: list[tuple[float, dict[str, Any]]] = []
    for row in range(200):
        force = 5.0 * np.sin(0.1 * row)
        place, speed = robot.joints.positions.tolist(), robot.joints.velocities.tolist()
        effort = [float(force), 0.0]
        message = {"name": list(JOINTS), "position": place, "velocity": speed, "effort": effort}
        messages.append((row / 240, message))
        robot.joints.set_torques([force, 0.0])
        world.step()
    file = write_json(tmp_path / "log.mcap", {"/joint_states": messages})
    result = identify(file, world, ["damping"], residuals="prediction")
    assert np.allclose(
        [*result.values.values()], [joint.damping for joint in robot.joints.movable], atol=1e-3
    )
