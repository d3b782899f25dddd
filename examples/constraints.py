"""Constraints: a weight hangs on a rod, a fixed constraint picks it up, and lets it fall again."""

import math

import pybullet as p
import pybullet_data
from carom.examples.window import connect, steps, wants_window

PICK, DROP = 240, 480


def main(duration=math.inf, window=True):
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    p.loadURDF("plane.urdf")
    weight = p.loadURDF("cube_small.urdf", [0.4, 0, 1])
    # A point-to-point constraint: the origin of the world, 1 m up, stays 0.4 m beside the middle of the cube.
    rope = p.createConstraint(weight, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [-0.4, 0, 0], [0, 0, 1])
    hand = None

    heights = []
    for step in steps(duration, window):
        if step == PICK:
            p.removeConstraint(rope)
            position, orientation = p.getBasePositionAndOrientation(weight)
            hand = p.createConstraint(
                weight, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], position, [0, 0, 0, 1], orientation
            )
            p.changeConstraint(hand, maxForce=200)
        elif hand is not None and step < DROP:
            lifted = [position[0], position[1], position[2] + 0.5 * (step - PICK) / (DROP - PICK)]
            p.changeConstraint(hand, lifted, orientation)
        elif hand is not None:
            p.removeConstraint(hand)
            hand = None
        p.stepSimulation()
        heights.append(p.getBasePositionAndOrientation(weight)[0][2])
    p.disconnect()
    return {"height": heights}


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 3)
