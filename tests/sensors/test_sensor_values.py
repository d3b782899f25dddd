"""What sensors show, beside what MuJoCo 4.0.0 shows of the same scenes (data/record.py has recorded it)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import Body, Motor, World
from carom.description import Collision, ContactParameters, Pose
from carom.description.geometry import Box, Plane
from carom.description.sensor import SensorKind
from carom.description.sensors import (
    Accelerometer,
    Clock,
    Gyro,
    JointLimitForce,
    RangeFinder,
    Sensor,
    Touch,
    Velocimeter,
)
from carom.model.body_spec import BodySpec, LinkSpec
from carom.scene.sensors.vectors import turned

DATA = Path(__file__).parent / "data"
RECORDED = json.loads((DATA / "mujoco.json").read_text(encoding="utf-8"))
SHORT = 1e-6
SITES = {
    "s_arm": ("arm", (0.05, 0.02, -0.1), (0.5, 0.5, -0.1, 0.7)),
    "s_fore": ("fore", (0.01, 0.02, -0.3), (0.9, -0.2, 0.3, 0.1)),
    "s_tool": ("tool", (0.01, 0.0, 0.02), (0.7, 0.1, 0.6, 0.2)),
}


def frame(position: Sequence[float], wxyz: Sequence[float]) -> Pose:
    w, x, y, z = np.array(wxyz) / np.linalg.norm(wxyz)
    px, py, pz = position
    return Pose((px, py, pz), (float(x), float(y), float(z), float(w)))


def kinds() -> dict[str, type[Sensor]]:
    """The classes of sensors by MuJoCo's names."""
    found: dict[str, type[Sensor]] = {}
    pending: list[type[Sensor]] = [Sensor]
    while pending:
        one = pending.pop()
        pending += one.__subclasses__()
        if "kind" in vars(one):
            found[one.kind.value] = one
    return found


def made(name: str) -> Sensor:
    """The sensor with a name of data/record.py."""
    kind, *rest = name.split()
    cls: Any = kinds()[kind]
    if cls is Clock:
        return Clock()
    if not kind.startswith("frame"):
        return cls(rest[0])
    return cls(site=rest[0], reference_link="arm") if len(rest) > 1 else cls(site=rest[0])


def arm(time_step: float = SHORT) -> Body:
    world = World(time_step)
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(DATA / "arm.urdf", (0.0, 0.0, 1.0), fixed_base=True)[0]
    for name, (link, position, turn) in SITES.items():
        body.add_site(name, link, frame(position, turn))
    body.add_actuator("m1", Motor("shoulder", gear=2.0))
    body.add_actuator("m2", Motor("elbow"))
    return body


def test_there_is_a_class_for_each_kind() -> None:
    assert kinds().keys() == {kind.value for kind in SensorKind}


@pytest.mark.parametrize("state", RECORDED["arm"], ids=range(len(RECORDED["arm"])))
def test_sensors_of_an_arm_show_what_those_of_mujoco_show(state: dict[str, Any]) -> None:
    body = arm()
    for name in state["sensors"]:
        body.add_sensor(name, made(name))
    body.joints.reset(state["q"], state["v"])
    body.actuators.controls = state["control"]
    beyond = state["sensors"]["jointlimitpos elbow"][0] < 0.0
    body.world.step()
    for name, shown in body.sensors.read().items():
        expected = np.array(state["sensors"][name])
        if "quat" in name:
            expected = expected[[1, 2, 3, 0]] * np.sign(expected[0] * shown[3])
        loads = name.startswith(("accel", "force", "torque", "framelinacc", "frameangacc"))
        if name == "clock":
            expected = [SHORT]
        elif beyond and (loads or "vel" in name or "gyro" in name or "mom" in name):
            continue  # a limit of another stiffness has changed velocities
        scale = max(1.0, float(np.abs(expected).max()))
        assert_allclose(shown, expected, rtol=0.0, atol=2e-4 * scale if loads else 1e-4 * scale, err_msg=name)


def test_the_error_of_loads_falls_with_the_time_step() -> None:
    errors = []
    for time_step in (1e-3, 1e-4):
        body, state = arm(time_step), RECORDED["arm"][1]
        names = [name for name in state["sensors"] if name.startswith(("accel", "force", "torque", "framel"))]
        for name in names:
            body.add_sensor(name, made(name))
        body.joints.reset(state["q"], state["v"])
        body.actuators.controls = state["control"]
        body.world.step()
        shown = body.sensors.read()
        errors.append(max(np.abs(shown[name] - state["sensors"][name]).max() for name in names))
    assert errors[1] < 0.2 * errors[0]


def resting_box() -> Body:
    """The box of data/record.py."""
    world = World(2e-4)
    world.gravity = (0.0, 0.0, -9.81)
    surface = ContactParameters(lateral_friction=1.0)
    ground = LinkSpec("ground", collisions=(Collision(Plane((0.0, 0.0, 1.0))),), contact=surface)
    world.load(BodySpec("ground", ground, fixed_base=True))
    a, b, c = 0.4, 0.3, 0.04
    inertia = tuple(2.0 / 12.0 * (s - d) for s, d in ((a * a + b * b + c * c, d * d) for d in (a, b, c)))
    rubber = ContactParameters(lateral_friction=0.5)
    x, y, z = inertia
    link = LinkSpec(
        "base",
        mass=2.0,
        inertia=(x, y, z),
        collisions=(Collision(Box((a / 2, b / 2, c / 2))),),
        contact=rubber,
    )
    body = world.load(BodySpec("box", link, is_held=False, link_damping=0.0), (0.0, 0.0, 0.02))
    body.add_site("imu", -1, frame((0.02, 0.03, 0.01), (0.7, 0.1, 0.6, 0.2)))
    body.add_site("skin", shape="box", size=(0.21, 0.16, 0.03))
    body.add_site("half", pose=Pose((0.2, 0.0, -0.02)), shape="box", size=(0.05, 0.2, 0.01))
    body.add_site("eye", pose=Pose((0.0, 0.0, 0.01), (1.0, 0.0, 0.0, 0.0)))
    for sensor in (Accelerometer("imu"), Gyro("imu"), Velocimeter("imu"), Touch("skin"), Touch("half")):
        body.add_sensor(f"{sensor.kind.value} {sensor.spec('').object}", sensor)
    body.add_sensor("rangefinder eye", RangeFinder("eye"))
    return body


def test_a_resting_box_feels_its_weight() -> None:
    body = resting_box()
    body.world.step(2500)
    for name, shown in body.sensors.read().items():
        assert_allclose(shown, RECORDED["box"]["0.5"][name], rtol=1e-3, atol=1e-3, err_msg=name)


def test_a_limit_carries_the_weight_of_what_it_stops() -> None:
    body = arm(1e-3)
    body.add_sensor("stop", JointLimitForce("elbow"))
    body.add_sensor("held", made("force s_tool"))
    body.joints["shoulder"].damping = 1e5
    body.joints.reset([2.9, 0.69])
    body.joints["elbow"].damping = 0.5
    body.world.step(4000)
    joint, link = body.joints["elbow"], body.links["fore"]
    weights = [(it.mass, it.inertial_pose.position) for it in (link, body.links["tool"])]
    axis = body.links["fore"].pose
    pivot = axis.position
    direction = turned(axis.orientation, np.array([1.0, 0.0, 0.0]))
    torque = sum(
        float(np.cross(place - pivot, [0.0, 0.0, -9.81 * mass]) @ direction) for mass, place in weights
    )
    assert torque > 0.5  # gravity presses the joint against its upper limit
    assert joint.position == pytest.approx(0.698, abs=0.01)
    assert body.sensors["stop"].read()[0] == pytest.approx(torque, rel=1e-3)
    assert np.linalg.norm(body.sensors["held"].read()) == pytest.approx(0.2 * 9.81, rel=1e-3)
