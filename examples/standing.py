"""A walking robot stands, takes a push, and sits down; in the window you push it, and let it sit."""

import math

from camera import picture

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, button, connect, slider, steps, wants_window

STAND = {"hip": 0.0, "upper": 0.75, "lower": -1.5}
SIT = {"hip": 0.0, "upper": 1.2, "lower": -2.4}
PUSH = 60
"""Force of the push, which lasts a tenth of a second [N]."""


def load():
    """The floor and the robot, and for each of its joints the part of the leg it moves."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    robot = p.loadURDF("a1/a1.urdf", [0, 0, 0.32])
    joints = {}
    for joint in range(p.getNumJoints(robot)):
        info = p.getJointInfo(robot, joint)
        if info[2] == p.JOINT_REVOLUTE:
            joints[joint] = next(part for part in STAND if part in info[1].decode())
            p.resetJointState(robot, joint, STAND[joints[joint]])
    return robot, joints


def command(robot, joints, pose):
    for joint, part in joints.items():
        p.setJointMotorControl2(
            robot, joint, p.POSITION_CONTROL, pose[part], force=33, positionGain=0.2, maxVelocity=4
        )


def play(robot, joints):
    """The slider lets the robot sit down, and the button pushes it, until ESC."""
    sitting, push = slider("0 stand, 1 sit", 0, 1, 0), button("push")
    left = 0
    for _ in steps(math.inf, True):
        share = sitting()
        command(robot, joints, {part: (1 - share) * STAND[part] + share * SIT[part] for part in STAND})
        left = 24 if push() else left - 1
        if left > 0:
            p.applyExternalForce(robot, -1, [0, PUSH, 0], [0, 0, 0], p.LINK_FRAME)
        p.stepSimulation()


def main(duration=3.0, window=False):
    """A third of the time each: standing, pushed from the side, sitting down; height and way aside."""
    connect(window)
    robot, joints = load()
    if window:
        play(robot, joints)
        p.disconnect()
        return {}
    record = {"time": [], "height": [], "way aside": []}
    third = round(duration / TIME_STEP / 3)
    for step in steps(3 * third * TIME_STEP, window):
        command(robot, joints, STAND if step < 2 * third else SIT)
        if third <= step < third + 24:
            p.applyExternalForce(robot, -1, [0, PUSH, 0], [0, 0, 0], p.LINK_FRAME)
        p.stepSimulation()
        place, _ = p.getBasePositionAndOrientation(robot)
        record["time"].append((step + 1) * TIME_STEP)
        record["height"].append(place[2])
        record["way aside"].append(place[1])
        if step == third - 1:
            record["image"] = picture([0, 0, 0.2], 1.3)
            contacts = p.getContactPoints(robot)
            print(f"{len(contacts)} feet bear {sum(contact[9] for contact in contacts):.1f} N")
    print(f"it sits at a height of {record['height'][-1]:.3f} m")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window())
