"""Bodies made in plain Python, and the switches that leave nothing but rigid body dynamics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from carom import Body, World
from carom.description import JointType, Pose
from carom.description.pose import IDENTITY, Quaternion, Vector3
from carom.layouts.codes import MOTOR_MAX_IMPULSE
from carom.model.body_spec import BASE, BodySpec, LinkSpec

MOVING_TYPES = (
    JointType.REVOLUTE,
    JointType.CONTINUOUS,
    JointType.PRISMATIC,
    JointType.SPHERICAL,
    JointType.PLANAR,
)
ALL_TYPES = (*MOVING_TYPES, JointType.FIXED)
NO_BOUND = 1e15


def random_tree(
    seed: int,
    link_count: int,
    *,
    fixed_base: bool,
    joint_types: Sequence[JointType] = ALL_TYPES,
    is_chain: bool = False,
) -> BodySpec:
    """A tree of links with random joints, masses, inertias and rotated inertial frames."""
    rng = np.random.default_rng(seed)
    links = []
    for j in range(link_count):
        joint_type = joint_types[int(rng.integers(len(joint_types)))]
        parent = j - 1 if is_chain else int(rng.integers(-1, j))
        links.append(_random_link(rng, f"link{j}", parent, joint_type))
    base = _random_link(rng, "base", BASE, JointType.FIXED)
    return BodySpec(f"random{seed}", base, links, fixed_base=fixed_base)


def _random_link(rng: np.random.Generator, name: str, parent: int, joint_type: JointType) -> LinkSpec:
    mass = float(rng.uniform(0.5, 2.0))
    # The centre of mass of a planar joint's link is where the joint is, as in Bullet.
    centre = (0.0, 0.0, 0.0) if joint_type == JointType.PLANAR else _vector(rng, 0.2)
    return LinkSpec(
        name=name,
        parent=parent,
        mass=mass,
        inertia=box_inertia(mass, _vector(rng, 0.1, 0.2)),
        inertial_frame=Pose(centre, random_rotation(rng)),
        joint_name=f"{name}_joint",
        joint_type=joint_type,
        joint_frame=Pose(_vector(rng, 0.4), random_rotation(rng)),
        joint_axis=_unit(rng),
    )


def box_inertia(mass: float, size: Vector3) -> Vector3:
    """Principal moments of a homogeneous box."""
    x, y, z = (length * length for length in size)
    return mass * (y + z) / 12.0, mass * (x + z) / 12.0, mass * (x + y) / 12.0


def _vector(rng: np.random.Generator, spread: float, offset: float = 0.0) -> Vector3:
    x, y, z = (offset + rng.uniform(-spread, spread, 3)).tolist()
    return x, y, z


def _unit(rng: np.random.Generator) -> Vector3:
    direction = rng.normal(size=3)
    x, y, z = (direction / np.linalg.norm(direction)).tolist()
    return x, y, z


def random_rotation(rng: np.random.Generator) -> Quaternion:
    """A unit quaternion, all orientations being equally likely."""
    direction = rng.normal(size=4)
    x, y, z, w = (direction / np.linalg.norm(direction)).tolist()
    return x, y, z, w


def rod(parent: int = BASE, *, mass: float = 2.0, length: float = 1.0, **joint: Any) -> LinkSpec:
    """A thin rod that hangs down from a joint about y at its upper end."""
    moment = mass * length**2 / 12.0
    settings: dict = {
        "joint_type": JointType.REVOLUTE,
        "joint_axis": (0.0, 1.0, 0.0),
        "joint_frame": IDENTITY if parent == BASE else Pose((0.0, 0.0, -length)),
        **joint,
    }
    return LinkSpec(
        name=f"rod{parent + 1}",
        parent=parent,
        mass=mass,
        inertia=(moment, moment, 1e-3 * moment),
        inertial_frame=Pose((0.0, 0.0, -length / 2.0)),
        joint_name=f"joint{parent + 1}",
        **settings,
    )


def pendulum(link_count: int = 1, **joint: Any) -> BodySpec:
    """A chain of 1 m rods of 2 kg hanging from a fixed base."""
    return BodySpec(
        "pendulum", LinkSpec("base"), [rod(j - 1, **joint) for j in range(link_count)], fixed_base=True
    )


def free_body(mass: float = 1.0, inertia: Vector3 = (0.1, 0.2, 0.3)) -> BodySpec:
    """One rigid body without joints."""
    return BodySpec("free", LinkSpec("base", mass=mass, inertia=inertia))


def let_go(body: Body) -> None:
    """Switch off the motors of a body, its damping and the bound on its velocities."""
    rates = slice(body.first_velocity, body.first_velocity + 6 + sum(body.velocity_count))
    body.world.motor[rates, MOTOR_MAX_IMPULSE] = 0.0
    body.change_dynamics(BASE, linear_damping=0.0, angular_damping=0.0, max_joint_velocity=NO_BOUND)


def put_in_motion(body: Body, rng: np.random.Generator, speed: float = 1.0) -> None:
    """Give the base and the joints random positions and velocities; a fixed base stays at rest."""
    x, y, z = rng.normal(size=3)
    body.set_inertial_pose((x, y, z), random_rotation(rng))
    if not body.fixed_base:
        body.set_base_velocity((speed * rng.normal(size=3)).tolist(), (speed * rng.normal(size=3)).tolist())
    for joint, count in enumerate(body.position_count):
        position = random_rotation(rng) if count == 4 else rng.uniform(-math.pi, math.pi, count)
        body.set_joint_state(
            joint, tuple(position), tuple(speed * rng.normal(size=body.velocity_count[joint]))
        )


def coordinates(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Views of a body's positions and velocities, those of its base first."""
    world: World = body.world
    q, v = body.first_position, body.first_velocity
    return (
        world.position[q : q + 7 + sum(body.position_count)],
        world.velocity[v : v + 6 + sum(body.velocity_count)],
    )


def joint_coordinates(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Views of the positions and velocities of a body's joints."""
    position, velocity = coordinates(body)
    return position[7:], velocity[6:]
