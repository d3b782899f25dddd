"""Inverse kinematics: the hand of the Panda follows a circle, and the joints stay within their limits."""

import math

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

HAND = 11
# Of the seven joints of the arm, and of the two fingers.
REST = [0, -0.4, 0, -2.2, 0, 1.9, 0.8, 0.04, 0.04]
DOWN = [math.pi, 0, 0]


def load():
    """The robot in its rest pose, and its joints that move: their numbers, lower and upper limits."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    info = [p.getJointInfo(panda, joint) for joint in range(p.getNumJoints(panda))]
    moving = [joint for joint in info if joint[2] != p.JOINT_FIXED]
    joints, lower, upper = ([joint[field] for joint in moving] for field in (0, 8, 9))
    for joint, position in zip(joints, REST, strict=True):
        p.resetJointState(panda, joint, position)
    return panda, joints, lower, upper


def solve(panda, goal, lower, upper, rest=REST):
    """Positions of all joints that move, with the hand at the goal and pointing down."""
    return p.calculateInverseKinematics(
        panda,
        HAND,
        goal,
        p.getQuaternionFromEuler(DOWN),
        lowerLimits=lower,
        upperLimits=upper,
        jointRanges=[high - low for low, high in zip(lower, upper, strict=True)],
        restPoses=rest,
        maxNumIterations=50,
    )


def main(duration=math.inf, window=True):
    connect(window)
    p.setGravity(0, 0, -9.81)
    panda, joints, lower, upper = load()
    radius = slider("radius [m]", 0.02, 0.2, 0.1)

    record = {"error": [], "positions": [], "lower": lower, "upper": upper}
    for step in steps(duration, window):
        angle = 2 * math.pi * step * TIME_STEP / 4
        goal = [0.5 + radius() * math.cos(angle), radius() * math.sin(angle), 0.4]
        positions = solve(panda, goal, lower, upper)
        p.setJointMotorControlArray(panda, joints, p.POSITION_CONTROL, positions)
        p.stepSimulation()
        hand = p.getLinkState(panda, HAND, computeForwardKinematics=1)[4]
        record["error"].append(math.dist(hand, goal))
        record["positions"].append(positions)
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 4)
