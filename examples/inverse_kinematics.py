"""Inverse kinematics: the hand of the Panda follows a circle, and the joints stay within their limits."""

import math

import numpy as np
from _window import TIME_STEP, connect, slider, steps, wants_window

import pybullet as p
import pybullet_data

HAND, ARM_JOINTS = 11, 7
REST = [0, -0.4, 0, -2.2, 0, 1.9, 0.8]
DOWN = [math.pi, 0, 0]


def main(duration=math.inf, window=True):
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    info = [p.getJointInfo(panda, joint) for joint in range(ARM_JOINTS)]
    lower, upper = [joint[8] for joint in info], [joint[9] for joint in info]
    for joint, position in enumerate(REST):
        p.resetJointState(panda, joint, position)
    radius = slider("radius [m]", 0.02, 0.2, 0.1)

    errors = []
    for step in steps(duration, window):
        angle = 2 * math.pi * step * TIME_STEP / 4
        goal = [0.5 + radius() * math.cos(angle), radius() * math.sin(angle), 0.4]
        solution = p.calculateInverseKinematics(
            panda,
            HAND,
            goal,
            p.getQuaternionFromEuler(DOWN),
            lowerLimits=lower,
            upperLimits=upper,
            jointRanges=np.subtract(upper, lower).tolist(),
            restPoses=REST,
            maxNumIterations=50,
        )
        joints = list(range(ARM_JOINTS))
        p.setJointMotorControlArray(panda, joints, p.POSITION_CONTROL, solution[:ARM_JOINTS])
        p.stepSimulation()
        hand = p.getLinkState(panda, HAND, computeForwardKinematics=1)[4]
        errors.append(math.dist(hand, goal))
    p.disconnect()
    return {"error": errors}


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 4)
