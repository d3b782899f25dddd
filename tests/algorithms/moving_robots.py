"""Robots in motion for the tests of derivatives, and small changes of their positions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from tests.physics.robots import random_tree

import pybullet_data
from carom import Body, World
from carom.description.transform import multiplied, rotation_matrix
from carom.layouts.codes import DOF_COUNT, POSITION_COUNT, JointCode

Vector = NDArray[np.float64]

ASSETS = pybullet_data.getDataPath()
GRAVITY = (0.4, -0.2, -9.81)
# A fixed arm, two free robots, the second with spherical joints, and trees with all kinds of joints.
ROBOTS = ("panda", "laikago", "humanoid", "fixed tree", "free tree")
FILES = {
    "panda": ("franka_panda/panda.urdf", True),
    "laikago": ("laikago/laikago.urdf", False),
    "humanoid": ("humanoid/humanoid.urdf", False),
}
STEP = 1e-5


def load(world: World, name: str) -> Body:
    if name in FILES:
        path, is_fixed = FILES[name]
        return world.load_urdf(f"{ASSETS}/{path}", (0.2, 0.1, 0.5), (0.1, 0.2, 0.3, 0.9), fixed_base=is_fixed)
    body = world.load(random_tree(4, 9, fixed_base=name == "fixed tree"))
    kinds = {JointCode(code) for code in body.joint_types}
    assert {JointCode.SPHERICAL, JointCode.PRISMATIC, JointCode.PLANAR} <= kinds
    return body


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """A robot, and positions, velocities, accelerations and forces in the order of the velocities."""

    body: Body
    q: Vector
    v: Vector
    a: Vector
    tau: Vector

    @property
    def free(self) -> int:
        """Number of velocities of the base."""
        return 0 if self.body.fixed_base else 6


def motion_of(name: str, seed: int = 0) -> Motion:
    world = World()
    world.gravity = GRAVITY
    body = load(world, name)
    for link, count in enumerate(body.velocity_count):
        if count:
            body.change_dynamics(link, joint_armature=0.02 * (1 + link))
    rng = np.random.default_rng(seed)
    base = [] if body.fixed_base else [rng.normal(size=3), unit_quaternion(rng)]
    joints = [
        unit_quaternion(rng) if count == 4 else rng.uniform(-1.0, 1.0, count) for count in body.position_count
    ]
    dofs = sum(body.velocity_count) + (0 if body.fixed_base else 6)
    return Motion(body, np.concatenate([*base, *joints]), *rng.normal(size=(3, dofs)))


def unit_quaternion(rng: np.random.Generator) -> Vector:
    quaternion = rng.normal(size=4)
    return quaternion / np.linalg.norm(quaternion)


def rotation(quaternion: Vector) -> Vector:
    x, y, z, w = quaternion.tolist()
    return np.array(rotation_matrix((x, y, z, w)))


def turned(quaternion: Vector, change: Vector) -> Vector:
    """An orientation turned by a rotation vector along its own axes."""
    angle = float(np.linalg.norm(change))
    x, y, z, w = quaternion.tolist()
    a, b, c = (np.sin(0.5 * angle) / angle * change if angle > 0.0 else 0.0 * change).tolist()
    return np.array(multiplied((x, y, z, w), (a, b, c, np.cos(0.5 * angle))))


def moved(body: Body, q: Vector, change: Vector) -> Vector:
    """Positions after a change that is a velocity times a unit of time, as a step integrates it."""
    new, at, dof = q.copy(), 0, 0
    if not body.fixed_base:
        new[:3] += rotation(q[3:7]) @ change[3:6]
        new[3:7] = turned(q[3:7], change[:3])
        at, dof = 7, 6
    for link, code in enumerate(JointCode(code) for code in body.joint_types):
        own = change[dof : dof + DOF_COUNT[code]]
        if code == JointCode.SPHERICAL:
            new[at : at + 4] = turned(q[at : at + 4], own)
        elif code == JointCode.PLANAR:
            spec, row = body.world.arrays.model.numpy, body.first_link + 1 + link
            axis, first, second = (spec[f"link_{name}"][row] for name in AXES)
            half = 0.5 * float(q[at])
            turn = rotation(np.array([*(np.sin(half) * axis), np.cos(half)]))
            slide = turn @ (first * own[1] + second * own[2])
            new[at : at + 3] += [own[0], first @ slide, second @ slide]
        else:
            new[at : at + len(own)] += own
        at, dof = at + POSITION_COUNT[code], dof + DOF_COUNT[code]
    return new


AXES = ("unit_axis", "planar_axis1", "planar_axis2")


def by_position(motion: Motion, function: Callable[[Vector], Vector]) -> Vector:
    """Central differences of a function of positions: a column for each velocity."""
    return by_vector(len(motion.v), lambda change: function(moved(motion.body, motion.q, change)))


def by_vector(length: int, function: Callable[[Vector], Vector]) -> Vector:
    """Central differences of a function at 0."""
    columns = [(function(STEP * unit) - function(-STEP * unit)) / (2.0 * STEP) for unit in np.eye(length)]
    return np.stack(columns, axis=-1)


def is_close(found: Vector, expected: Vector, tolerance: float = 1e-6) -> bool:
    """Whether arrays agree, relative to the largest entry."""
    return bool(np.abs(found - expected).max() <= tolerance * max(1.0, float(np.abs(expected).max())))
