"""Sliders that set the target positions of a robot's joints."""

from __future__ import annotations

import time

import pybullet


def follow_sliders(robot: int, force: float) -> None:
    """Moves the joints of a robot to the values of their sliders, in real time, until the window is closed.

    Args:
        robot: The body.
        force: Maximum torque of each motor [N m].
    """
    joints = [
        joint
        for joint in range(pybullet.getNumJoints(robot))
        if pybullet.getJointInfo(robot, joint)[2] in (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC)
    ]
    sliders = [
        pybullet.addUserDebugParameter(
            pybullet.getJointInfo(robot, joint)[1].decode(), -4, 4, pybullet.getJointState(robot, joint)[0]
        )
        for joint in joints
    ]
    time_step = pybullet.getPhysicsEngineParameters()["fixedTimeStep"]
    while pybullet.isConnected():
        targets = [pybullet.readUserDebugParameter(slider) for slider in sliders]
        pybullet.setJointMotorControlArray(
            robot, joints, pybullet.POSITION_CONTROL, targets, forces=[force] * len(joints)
        )
        pybullet.stepSimulation()
        time.sleep(time_step)
