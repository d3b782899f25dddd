"""Bodies that scripts make of shapes, moving without touching anything."""

from __future__ import annotations

from math import cos, sin
from typing import Any

from ..scenario import base_motion, joint_motion, movable_joints, release_motors, scenario, simulate, under


def _chain(p: Any, count: int, base_mass: float, **options: Any) -> int:
    """Rods on turning joints whose axes alternate, each a capsule off its joint."""
    rod = p.createCollisionShape(p.GEOM_CAPSULE, radius=0.03, height=0.3, collisionFramePosition=[0, 0, -0.2])
    block = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.15, 0.05])
    return p.createMultiBody(
        baseMass=base_mass,
        baseCollisionShapeIndex=block,
        linkMasses=[0.6 - 0.05 * j for j in range(count)],
        linkCollisionShapeIndices=[rod] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.0, 0.02, -0.05 if j == 0 else -0.4] for j in range(count)],
        linkOrientations=[[0.0, 0.0, sin(0.3 * j), cos(0.3 * j)] for j in range(count)],
        linkInertialFramePositions=[[0.01, 0.0, -0.2]] * count,
        linkInertialFrameOrientations=[[sin(0.1), 0.0, 0.0, cos(0.1)]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[p.JOINT_REVOLUTE] * count,
        linkJointAxis=[[1, 0, 0] if j % 2 else [0, 1, 0] for j in range(count)],
        **options,
    )


def _observe(p: Any, bodies: dict[str, int]) -> dict[str, Any]:
    observed: dict[str, Any] = {}
    for name, body in bodies.items():
        observed |= under(name, base_motion(p, body))
        if movable_joints(p, body):
            observed |= under(name, joint_motion(p, body, movable_joints(p, body)))
    return observed


@scenario()
def made_chains_swing_and_fall(p: Any) -> dict[str, Any]:
    """Chains made by createMultiBody: one hangs on a fixed base, one falls, motors off."""
    p.setGravity(0, 0, -9.81)
    turned = p.getQuaternionFromEuler([0.3, 0.4, 0.5])
    bodies = {
        "hanging": _chain(p, 4, 0.0, basePosition=[0, 0, 3], baseOrientation=turned),
        "falling": _chain(p, 3, 1.2, basePosition=[3, 0, 20], baseOrientation=turned),
    }
    for body in bodies.values():
        release_motors(p, body)
        for joint in movable_joints(p, body):
            p.resetJointState(body, joint, 0.3 * joint - 0.2, 0.5)
    return simulate(p, 1.5, lambda: _observe(p, bodies))


@scenario()
def made_tree_with_all_joints(p: Any) -> dict[str, Any]:
    """A tree of turning, sliding and fixed joints, made in another order than its links get, with motors."""
    p.setGravity(0, 0, -9.81)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.05])
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    drum = p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.3)
    body = p.createMultiBody(
        1.0,
        box,
        -1,
        [0, 0, 10],
        [0, 0, 0, 1],
        [0.05, 0.0, 0.0],
        [0, 0, sin(0.2), cos(0.2)],
        linkMasses=[0.5, 0.4, 0.3, 0.7, 0.2],
        linkCollisionShapeIndices=[drum, ball, -1, box, ball],
        linkVisualShapeIndices=[-1] * 5,
        linkPositions=[[0.2, 0, 0], [0, 0.3, 0], [0.1, 0.1, 0.2], [-0.3, 0, 0], [0, 0, 0.3]],
        linkOrientations=[[0, 0, 0, 1], [0, 0.6, 0, 0.8], [0, 0, 0, 1], [0.6, 0, 0, 0.8], [0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0.1], [0, 0, 0], [0, 0, 0], [0, 0.1, 0], [0.02, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * 5,
        linkParentIndices=[0, 1, 2, 0, 4],
        linkJointTypes=[
            p.JOINT_REVOLUTE,
            p.JOINT_PRISMATIC,
            p.JOINT_FIXED,
            p.JOINT_REVOLUTE,
            p.JOINT_REVOLUTE,
        ],
        linkJointAxis=[[0, 0, 1], [1, 0, 0], [0, 0, 0], [0, 1, 0], [1, 1, 0]],
    )
    joints = movable_joints(p, body)
    p.setJointMotorControlArray(
        body, joints, p.POSITION_CONTROL, targetPositions=[0.5, 0.1, -0.4, 0.3], forces=[2, 2, 2, 2]
    )
    return simulate(p, 1.0, lambda: _observe(p, {"tree": body}))


@scenario()
def made_bodies_spin(p: Any) -> dict[str, Any]:
    """Free bodies of every shape, thrown: their inertias follow from their shapes."""
    shapes = {
        "ball": p.createCollisionShape(p.GEOM_SPHERE, radius=0.2),
        "box": p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3]),
        "capsule": p.createCollisionShape(p.GEOM_CAPSULE, radius=0.1, height=0.4),
        "cylinder": p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.4),
        "hull": p.createCollisionShape(
            p.GEOM_MESH, vertices=[[0, 0, 0], [0.4, 0, 0], [0, 0.3, 0], [0, 0, 0.5], [0.2, 0.2, 0.2]]
        ),
        "compound": p.createCollisionShapeArray(
            [p.GEOM_SPHERE, p.GEOM_BOX],
            radii=[0.1, 0.0],
            halfExtents=[[0, 0, 0], [0.1, 0.2, 0.05]],
            collisionFramePositions=[[0.3, 0, 0], [-0.1, 0, 0]],
            collisionFrameOrientations=[[0, 0, 0, 1], [0, 0, 0.6, 0.8]],
        ),
    }
    bodies = {
        name: p.createMultiBody(
            0.5 + 0.1 * i,
            shape,
            basePosition=[2.0 * i, 0, 0],
            baseInertialFramePosition=[0.0, 0.01 * i, 0.0],
            baseInertialFrameOrientation=[0.0, sin(0.05 * i), 0.0, cos(0.05 * i)],
        )
        for i, (name, shape) in enumerate(shapes.items())
    }
    for body in bodies.values():
        p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [3.0, -4.0, 5.0])
    return simulate(p, 1.0, lambda: _observe(p, bodies))
