"""A Franka Panda picks up a cube and holds it in the air; in the window a slider says how high."""

import math

from camera import picture

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

ARM = range(7)
FINGERS = (9, 10)
GRASP_TARGET = 11
HOME = (0.0, -0.3, 0.0, -2.3, 0.0, 2.0, 0.785)
MAX_FORCES = (87, 87, 87, 87, 12, 12, 12)
OPEN, CLOSED = 0.04, 0.0
ABOVE, AT_CUBE, LIFTED = 0.2, 0.025, 0.3

PHASES = {
    "over the cube": (ABOVE, OPEN),
    "down": (AT_CUBE, OPEN),
    "grasp": (AT_CUBE, CLOSED),
    "lift": (LIFTED, CLOSED),
    "hold": (LIFTED, CLOSED),
}


def load():
    """The floor, the Panda with its hand open, and a cube in front of it."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    for joint, angle in zip(ARM, HOME, strict=True):
        p.resetJointState(panda, joint, angle)
    for finger in FINGERS:
        p.resetJointState(panda, finger, OPEN)
    return panda, p.loadURDF("cube_small.urdf", [0.5, 0, 0.025])


def command(panda, height, opening):
    """Ask the arm to be over the cube at a height, and the fingers to be apart."""
    downwards = p.getQuaternionFromEuler([3.14159265, 0, 0])
    angles = p.calculateInverseKinematics(
        panda, GRASP_TARGET, [0.5, 0, height], downwards, maxNumIterations=50, residualThreshold=1e-5
    )
    for joint in ARM:
        p.setJointMotorControl2(
            panda, joint, p.POSITION_CONTROL, angles[joint], force=MAX_FORCES[joint], maxVelocity=1
        )
    for finger in FINGERS:
        p.setJointMotorControl2(panda, finger, p.POSITION_CONTROL, opening, force=20)


def main(duration=1.0, window=False):
    """Run through the phases, `duration` seconds each; heights, the fingers' opening and their force."""
    connect(window)
    panda, cube = load()
    lifted = slider("height when lifted [m]", 0.1, 0.6, LIFTED)
    record = {"time": [], "cube": [], "hand": [], "opening": [], "press": []}
    for name, (height, opening) in PHASES.items():
        # In the window the cube is held until ESC.
        for _ in steps(math.inf if window and name == "hold" else duration, window):
            command(panda, lifted() if height == LIFTED else height, opening)
            p.stepSimulation()
            fingers = [p.getJointState(panda, finger)[0] for finger in FINGERS]
            record["time"].append((len(record["time"]) + 1) * TIME_STEP)
            record["cube"].append(p.getBasePositionAndOrientation(cube)[0][2])
            record["hand"].append(p.getLinkState(panda, GRASP_TARGET)[0][2])
            record["opening"].append(sum(fingers))
            contacts = p.getContactPoints(panda, cube, FINGERS[0])
            record["press"].append(sum(contact[9] for contact in contacts))
        if not p.isConnected():
            return record
        print(f"{name:14}: cube at {record['cube'][-1]:.3f} m, fingers press {record['press'][-1]:.1f} N")
    record["image"] = picture([0.35, 0, 0.35], 1.1, yaw=50)
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window())
