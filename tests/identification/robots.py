"""Simulated robots with known parameters, and logs of their motion."""

from __future__ import annotations

from typing import Any

import numpy as np

import pybullet_data
from carom import Body, World
from carom.algorithms import inertial_parameters, inverse_dynamics
from carom.identification.link_inertia import set_link_inertia
from carom.identification.pseudo_inertia import centre_and_inertia
from carom.linearization.inputs import INERTIAL_NUMBERS

ASSETS = pybullet_data.getDataPath()
STEP = 1 / 240
LINKS = (*(f"panda_link{number}" for number in range(1, 8)), "panda_hand")
JOINTS = tuple(f"panda_joint{number}" for number in range(1, 8))
ARM = 7
_MIDDLE = np.array([0.0, 0.2, 0.0, -1.6, 0.0, 1.8, 0.0])
_AMPLITUDE = np.array([1.0, 0.6, 1.0, 0.6, 1.0, 0.8, 1.0])


def load(path: str) -> tuple[World, Body]:
    """A world with a robot on a fixed base, all motors off."""
    world = World(time_step=STEP)
    world.gravity = (0.0, 0.0, -9.81)
    robot = world.load_urdf(f"{ASSETS}/{path}", fixed_base=True)
    robot.joints.free()
    return world, robot


def panda() -> tuple[World, Body]:
    """The Panda, whose fingers are held."""
    world, robot = load("franka_panda/panda.urdf")
    for finger in robot.joints.movable[ARM:]:
        finger.set_position_target(0.02)
    return world, robot


def panda_parameters(robot: Body) -> list[str]:
    """Names of all that is fitted."""
    ends = ("damping", "armature", "joint_friction")
    return [
        *(f"{robot.name}.{link}.inertial" for link in LINKS),
        *(f"{robot.name}.{joint}.{end}" for end in ends for joint in JOINTS),
    ]


def disturbed(parameters: np.ndarray, coordinates: np.ndarray) -> np.ndarray:
    """Other physical inertial parameters of a link, by log-Cholesky coordinates of its pseudo-inertia."""
    mass, (xx, xy, yy, xz, yz, zz) = parameters[0], parameters[4:]
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    pseudo = np.diag([0.0, 0.0, 0.0, mass])
    pseudo[:3, :3] = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    pseudo[:3, 3] = pseudo[3, :3] = parameters[1:4]
    triangle = np.diag(np.exp(coordinates[:4]))
    triangle[(1, 2, 2, 3, 3, 3), (0, 0, 1, 0, 1, 2)] = coordinates[4:]
    factor = np.linalg.cholesky(pseudo) @ triangle
    pseudo = factor @ factor.T
    inertia = np.trace(pseudo[:3, :3]) * np.eye(3) - pseudo[:3, :3]
    return np.array([pseudo[3, 3], *pseudo[:3, 3], *inertia[(0, 0, 1, 0, 1, 2), (0, 1, 1, 2, 2, 2)]])


def disturb(robot: Body, rng: np.random.Generator) -> None:
    """Give the Panda other inertias, friction, damping and armature."""
    before = inertial_parameters(robot)
    for name in LINKS:
        link = robot.links[name].index
        if robot.dynamics(link).mass > 0.0:
            other = disturbed(before[1 + link], rng.normal(0.0, 0.1, 10))
            set_link_inertia(robot, link, *centre_and_inertia(other))
    for joint in robot.joints.movable[:ARM]:
        joint.damping = rng.uniform(0.2, 1.5)
        joint.armature = rng.uniform(0.05, 0.3)
        joint.friction_loss = rng.uniform(0.2, 1.0)


def excited_panda(world: World, robot: Body, rng: np.random.Generator, duration: float) -> dict[str, Any]:
    """A log, without noise, of motion along sums of sines."""
    _, model = panda()
    rates, phases = 2.0 * np.pi * rng.uniform(0.1, 0.8, (ARM, 4)), rng.uniform(0.0, 2.0 * np.pi, (ARM, 4))
    shares = rng.dirichlet(np.ones(4), ARM) * _AMPLITUDE[:, None]
    count = round(duration / STEP)
    log = {name: np.zeros((count, ARM + 2)) for name in ("positions", "velocities", "torques")}
    log["torques"][:, ARM:] = np.nan
    for row in range(count):
        angle = rates * row * STEP + phases
        wanted = _MIDDLE + (shares * np.sin(angle)).sum(axis=1)
        speed = (shares * rates * np.cos(angle)).sum(axis=1)
        if row == 0:
            robot.joints.reset([*wanted, 0.02, 0.02], [*speed, 0.0, 0.0])
        q, v = robot.joints.positions, robot.joints.velocities
        pull = -(shares * rates**2 * np.sin(angle)).sum(axis=1)
        pull += 100.0 * (wanted - q[:ARM]) + 20.0 * (speed - v[:ARM])
        torque = inverse_dynamics(model, q, v, [*pull, 0.0, 0.0])[:ARM]
        log["positions"][row], log["velocities"][row], log["torques"][row, :ARM] = q, v, torque
        robot.joints.set_torques([*torque, 0.0, 0.0])
        world.step()
    return {"time": STEP * np.arange(count), **log}


def truth(robot: Body) -> dict[str, float]:
    """Parameters of a robot by name."""
    found: dict[str, float] = {}
    for link, numbers in zip(robot.spec.links, inertial_parameters(robot)[1:], strict=True):
        for name, value in zip(INERTIAL_NUMBERS, numbers, strict=True):
            found[f"{robot.name}.{link.name}.inertial.{name}"] = float(value)
    for joint in robot.joints.movable:
        found[f"{robot.name}.{joint.name}.damping"] = joint.damping
        found[f"{robot.name}.{joint.name}.armature"] = joint.armature
        found[f"{robot.name}.{joint.name}.joint_friction"] = joint.friction_loss
    return found


def errors(result: Any, true: dict[str, float]) -> np.ndarray:
    """Errors of the combinations, relative to their bounds."""
    return np.array(
        [
            (it.value - sum(factor * true[name] for name, factor in it.factors.items())) / it.bound
            for it in result.combinations
        ]
    )
