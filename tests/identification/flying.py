"""A flying robot with an arm, pushed at its base, and logs of its motion."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from tests.identification.robots import disturbed

from carom import Body, Force, Torque, World
from carom.algorithms import inertial_parameters
from carom.description.pose import Pose
from carom.identification.link_inertia import set_link_inertia
from carom.identification.pseudo_inertia import centre_and_inertia

STEP = 1 / 500
LINKS = ("base", "upper", "lower")
_URDF = """<robot name="flyer">
  <link name="body"><inertial><origin xyz="0.02 -0.01 0.03"/><mass value="2"/>
    <inertia ixx="0.03" iyy="0.04" izz="0.05" ixy="0.002" ixz="0" iyz="-0.001"/></inertial></link>
  <link name="upper"><inertial><origin xyz="0.01 0.02 -0.15"/><mass value="0.7"/>
    <inertia ixx="0.008" iyy="0.007" izz="0.003" ixy="0" ixz="0.0005" iyz="0"/></inertial></link>
  <link name="lower"><inertial><origin xyz="0 0.01 -0.1"/><mass value="0.4"/>
    <inertia ixx="0.004" iyy="0.003" izz="0.002" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="body"/><child link="upper"/>
    <origin xyz="0.05 0 -0.1" rpy="0.1 0 0.3"/><axis xyz="0 1 0"/></joint>
  <joint name="elbow" type="continuous"><parent link="upper"/><child link="lower"/>
    <origin xyz="0 0 -0.3"/><axis xyz="1 0 0"/></joint>
</robot>"""


def flyer(folder: Path, *, sensors: bool = False) -> tuple[World, Body]:
    """The robot in a world of its own, with a sensor of force and torque in its elbow if asked for."""
    path = folder / "flyer.urdf"
    path.write_text(_URDF)
    world = World(time_step=STEP, contact="rigid")
    world.gravity = (0.0, 0.0, -9.81)
    robot = world.load_urdf(str(path), (0.1, 0.2, 1.0), as_pybullet=False)
    robot.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0)
    robot.joints.free()
    if sensors:
        robot.add_site("wrist", "lower", Pose((0.02, -0.01, 0.03), (0.0, 0.6, 0.0, 0.8)))
        robot.add_sensor("push", Force("wrist"))
        robot.add_sensor("twist", Torque("wrist"))
    return world, robot


def disturb(robot: Body, rng: np.random.Generator, size: float = 0.1) -> None:
    """Give all links other inertias, and the joints damping."""
    for link, before in enumerate(inertial_parameters(robot), start=-1):
        set_link_inertia(robot, link, *centre_and_inertia(disturbed(before, rng.normal(0.0, size, 10))))
    for joint in robot.joints:
        joint.damping = rng.uniform(0.05, 0.2)


def flight(
    world: World, robot: Body, rng: np.random.Generator, count: int, *, pushed: bool = True
) -> dict[str, Any]:
    """A log, without noise: pushed at the base so that it stays about where it is, or falling."""
    rates = 2.0 * np.pi * rng.uniform(0.2, 1.0, (8, 3))
    phases = rng.uniform(0.0, 2.0 * np.pi, (8, 3))
    start = np.array(robot.pose.position)
    log: dict[str, Any] = {"time": STEP, "controls": {}}
    rows: dict[str, list[Any]] = {}
    for row in range(count):
        waves = np.sin(rates * row * STEP + phases).sum(axis=1)
        position, velocity = np.array(robot.pose.position), robot.velocity
        wrench = np.zeros(6)
        torques = 0.5 * waves[6:] - 0.3 * robot.joints.velocities - 1.0 * robot.joints.positions
        if pushed:
            wrench[:3] = 40.0 * (start - position) - 12.0 * velocity.linear + [0.0, 0.0, 30.0]
            wrench[:3] += 6.0 * waves[:3]
            wrench[3:] = 0.7 * waves[3:6] - 0.5 * velocity.angular
        seen = {
            "positions": robot.joints.positions,
            "velocities": robot.joints.velocities,
            "base_positions": position,
            "base_orientations": robot.pose.orientation,
            "base_velocities": np.concatenate(velocity),
            "torques": torques,
            "wrench": wrench,
            **{f"sensors.{sensor.name}": sensor.read() for sensor in robot.sensors},
        }
        for name, value in seen.items():
            rows.setdefault(name, []).append(np.array(value))
        robot.base.apply_force(wrench[:3], position)
        robot.base.apply_torque(wrench[3:])
        robot.joints.set_torques(torques)
        world.step()
    log |= {name: np.array(values) for name, values in rows.items()}
    log["forces"] = {"body": log.pop("wrench")} if pushed else {}
    if not pushed:
        log.pop("wrench", None)
    names = [name for name in log if name.startswith("sensors.")]
    log["sensors"] = {name.removeprefix("sensors."): log.pop(name) for name in names}
    return log


def with_noise(
    log: dict[str, Any], rng: np.random.Generator, position: float, force: float
) -> dict[str, Any]:
    """The same as measured: positions [m, rad], and forces [N, N m], have noise."""
    noisy = dict(log)
    for name in ("positions", "base_positions", "base_orientations"):
        noisy[name] = log[name] + rng.normal(0.0, position, log[name].shape)
    noisy["torques"] = log["torques"] + rng.normal(0.0, force, log["torques"].shape)
    for group in ("forces", "sensors"):
        noisy[group] = {name: it + rng.normal(0.0, force, it.shape) for name, it in log[group].items()}
    return noisy
