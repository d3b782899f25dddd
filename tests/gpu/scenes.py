"""Scenes with everything a step knows, made by the drop-in."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from tests.physics.robots import random_tree

import pybullet as p
import pybullet_data
from carom import World
from carom.layouts.codes import MOTOR_KP, MOTOR_POSITION, MOTOR_VELOCITY
from carom.model.body_spec import BASE
from pybullet._clients.clients import clients


@contextmanager
def scene(build: str, seed: int) -> Iterator[World]:
    """A world with the scene of a function below; parameters and motion depend on the seed."""
    client = p.connect(p.DIRECT)
    try:
        p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
        p.setGravity(0.01 * seed, 0, -9.81 - 0.1 * seed, physicsClientId=client)
        globals()[build](client)
        world = clients[client].world
        rng = np.random.default_rng(seed)
        for body in world.bodies.values():
            body.change_dynamics(BASE, lateral_friction=0.5 + 0.1 * seed)
            if not body.fixed_base:
                body.change_dynamics(BASE, mass=1.0 + 0.1 * seed)
        model = world.arrays.model.numpy
        for tree in range(world.arrays.used["tree"]):
            first, count = model["tree_first_dof"][tree], model["tree_dof_count"][tree]
            world.velocity[first : first + count] += rng.normal(0.0, 0.05, count)
        yield world
    finally:
        p.disconnect(client)


def arms(client: int) -> None:
    """Trees with joints of all kinds, motors and sensors that have no shapes."""
    world = clients[client].world
    for seed, fixed_base in ((0, True), (1, False), (2, True)):
        body = world.load(random_tree(seed, 8, fixed_base=fixed_base))
        body.set_sensor(2, True)
    count = world.arrays.used["dof"]
    rng = np.random.default_rng(3)
    world.motor[:count, MOTOR_VELOCITY] = rng.normal(size=count)
    world.motor[:count, MOTOR_POSITION] = 0.1 * rng.normal(size=count)
    world.motor[:count, MOTOR_KP] = 0.1


def heap(client: int) -> None:
    """Boxes, balls, cylinders and capsules that fall on a plane, some with rolling friction."""
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    shapes = [
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.08, 0.06], physicsClientId=client),
        p.createCollisionShape(p.GEOM_SPHERE, radius=0.08, physicsClientId=client),
        p.createCollisionShape(p.GEOM_CYLINDER, radius=0.07, height=0.12, physicsClientId=client),
        p.createCollisionShape(p.GEOM_CAPSULE, radius=0.05, height=0.1, physicsClientId=client),
    ]
    for i in range(12):
        body = p.createMultiBody(
            1.0,
            shapes[i % 4],
            basePosition=[0.13 * (i % 3), 0.11 * (i // 3 % 2), 0.1 + 0.16 * (i // 6)],
            physicsClientId=client,
        )
        p.changeDynamics(body, -1, ccdSweptSphereRadius=0.01 * (i % 2), physicsClientId=client)
        if i % 5 == 1:
            p.changeDynamics(
                body, -1, rollingFriction=0.01, spinningFriction=0.01, restitution=0.3, physicsClientId=client
            )


def stack(client: int) -> None:
    """Boxes at rest on each other, far from others that may fall asleep."""
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client), physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1], physicsClientId=client)
    for i in range(6):
        body = p.createMultiBody(
            1.0, shape, basePosition=[3.0 * (i % 2), 0, 0.1 + 0.2 * (i // 2)], physicsClientId=client
        )
        if i % 2 == 1:
            p.changeDynamics(
                body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING, physicsClientId=client
            )


def hurried_stack(client: int) -> None:
    """The same with so few sweeps that it cannot be solved as an island at rest, and is solved once more."""
    stack(client)
    p.setPhysicsEngineParameter(numSolverIterations=8, solverResidualThreshold=1e-20, physicsClientId=client)


def robots(client: int) -> None:
    """Robots with motors and sensors, on legs and on wheels, one of them tied; boxes tied to each other."""
    p.setPhysicsEngineParameter(numSubSteps=2, physicsClientId=client)
    p.loadURDF("plane.urdf", physicsClientId=client)
    legs = p.loadURDF("a1/a1.urdf", [0, 0, 0.4], flags=p.URDF_USE_SELF_COLLISION, physicsClientId=client)
    r2d2 = p.loadURDF("r2d2.urdf", [1.5, 0, 0.5], physicsClientId=client)
    for robot, target in ((legs, p.POSITION_CONTROL), (r2d2, p.VELOCITY_CONTROL)):
        for joint in range(p.getNumJoints(robot, physicsClientId=client)):
            p.enableJointForceTorqueSensor(robot, joint, physicsClientId=client)
            if p.getJointInfo(robot, joint, physicsClientId=client)[2] == p.JOINT_REVOLUTE:
                p.setJointMotorControl2(robot, joint, target, 0.5, force=20, physicsClientId=client)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1], physicsClientId=client)
    boxes = [
        p.createMultiBody(1.0, shape, basePosition=[-1.0 - 0.3 * i, 0, 0.15], physicsClientId=client)
        for i in range(3)
    ]
    for kind, parent, child in (
        (p.JOINT_POINT2POINT, boxes[0], boxes[1]),
        (p.JOINT_FIXED, boxes[1], boxes[2]),
        (p.JOINT_PRISMATIC, legs, -1),
    ):
        p.createConstraint(
            parent, -1, child, -1, kind, [1, 0, 0], [-0.15, 0, 0], [0.15, 0, 0], physicsClientId=client
        )


def late(client: int) -> None:
    """Robots whose links have late velocities, with and without sensors, beside one without."""
    p.loadURDF("plane.urdf", physicsClientId=client)
    for place, flags in enumerate((p.URDF_GLOBAL_VELOCITIES_MB, 0, p.URDF_GLOBAL_VELOCITIES_MB)):
        robot = p.loadURDF("r2d2.urdf", [1.5 * place, 0, 0.6], flags=flags, physicsClientId=client)
        p.resetBaseVelocity(robot, [0.1, 0.2, 0.3], [1, 2, 3], physicsClientId=client)
        if place == 2:
            p.enableJointForceTorqueSensor(robot, 1, physicsClientId=client)
