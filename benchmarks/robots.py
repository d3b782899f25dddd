"""Worlds of one robot with legs, for engines with PyBullet's interface."""

from __future__ import annotations

import crowds

import pybullet as p

STANCE = {"hip": 0.0, "upper": 0.75, "lower": -1.5}


def quadruped(plane: str, robot: str) -> None:
    """A walking robot that stands on its four feet."""
    p.loadURDF(plane)
    body = p.loadURDF(robot, [0.0, 0.0, 0.32])
    for joint in range(p.getNumJoints(body)):
        info = p.getJointInfo(body, joint)
        if info[2] == p.JOINT_REVOLUTE:
            angle = next(STANCE[part] for part in STANCE if part in info[1].decode())
            p.resetJointState(body, joint, angle)
            p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, angle, force=33, positionGain=0.2)
    crowds.settle(300)


def humanoid(plane: str, robot: str) -> None:
    """A humanoid with balls for joints that has fallen over and lies on the floor."""
    p.loadURDF(plane)
    p.loadURDF(robot, [0.0, 0.0, 0.9], globalScaling=0.25)
    crowds.settle(600)
