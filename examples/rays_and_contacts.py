"""Rays and contacts: a lidar of 36 rays, and what a box presses on the floor with.

Switch on "Rays", "Forces" and "Friction cones" under "Show".
"""

import math

import pybullet as p
import pybullet_data
from carom.examples.window import connect, slider, steps, wants_window

RAYS, REACH = 36, 2.0


def main(duration=math.inf, window=True):
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    plane = p.loadURDF("plane.urdf")
    box = p.loadURDF("cube.urdf", [0, 1, 0.25], globalScaling=0.5)
    p.changeDynamics(box, -1, mass=4)
    push = slider("push [N]", 0, 60, 0)
    around = [2 * math.pi * i / RAYS for i in range(RAYS)]
    starts = [[0, 0, 0.2]] * RAYS
    ends = [[REACH * math.cos(angle), REACH * math.sin(angle), 0.2] for angle in around]

    record = {"hits": [], "normal": [], "friction": []}
    for step in steps(duration, window):
        p.applyExternalForce(box, -1, [push(), 0, 0], p.getBasePositionAndOrientation(box)[0], p.WORLD_FRAME)
        p.stepSimulation()
        if step % 8 == 0:
            hits = p.rayTestBatch(starts, ends)
            record["hits"].append(sum(hit[0] == box for hit in hits))
        points = p.getContactPoints(box, plane)
        # Field 9 is the normal force, 10 and 12 are friction along the directions in 11 and 13.
        record["normal"].append(sum(point[9] for point in points))
        record["friction"].append(sum(math.hypot(point[10], point[12]) for point in points))
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 2)
