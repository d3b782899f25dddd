"""What is this robot made of? Reads R2D2's joints, masses and link poses.

In the window R2D2 falls on the floor, and the slider chooses a link: its name stands beside it.
"""

import math

import pybullet as p
import pybullet_data
from carom.examples.window import connect, slider, steps, wants_window

JOINT_TYPES = {
    p.JOINT_REVOLUTE: "revolute",
    p.JOINT_PRISMATIC: "prismatic",
    p.JOINT_SPHERICAL: "spherical",
    p.JOINT_PLANAR: "planar",
    p.JOINT_FIXED: "fixed",
}


def main(duration=0.1, window=False):
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    robot = p.loadURDF("r2d2.urdf", basePosition=[0, 0, 1])
    base_link, name = p.getBodyInfo(robot)
    print(f"{name.decode()}: base link {base_link.decode()!r}, {p.getNumJoints(robot)} joints\n")

    print(f"{'joint':30} {'type':10} {'axis':22} {'limits':18} {'parent':>6}")
    for joint in range(p.getNumJoints(robot)):
        info = p.getJointInfo(robot, joint)
        axis = " ".join(f"{component:5.2f}" for component in info[13])
        limits = f"{info[8]:.2f} .. {info[9]:.2f}" if info[8] <= info[9] else "none"
        print(f"{info[1].decode():30} {JOINT_TYPES[info[2]]:10} {axis:22} {limits:18} {info[16]:6}")

    for _ in steps(duration, False):
        p.stepSimulation()

    print(f"\n{'link':30} {'mass':>7} {'friction':>8} {'height':>8} {'falls at':>9}")
    heights = []
    for link in range(p.getNumJoints(robot)):
        dynamics = p.getDynamicsInfo(robot, link)
        state = p.getLinkState(robot, link, computeLinkVelocity=1)
        link_name = p.getJointInfo(robot, link)[12].decode()
        heights.append(state[4][2])
        print(f"{link_name:30} {dynamics[0]:7.3f} {dynamics[1]:8.2f} {state[4][2]:8.3f} {state[6][2]:9.3f}")
    if window:
        look_at_links(robot)
    p.disconnect()
    return {"height": heights}


def look_at_links(robot):
    """Lets the robot fall, and writes the name of the link that the slider chooses beside it, until ESC."""
    p.loadURDF("plane.urdf")
    chosen = slider("link", 0, p.getNumJoints(robot) - 1, 0)
    label, named = -1, -1
    for _ in steps(math.inf, True):
        p.stepSimulation()
        link = round(chosen())
        if link != named:
            if label >= 0:
                p.removeUserDebugItem(label)
            name = p.getJointInfo(robot, link)[12].decode()
            label = p.addUserDebugText(
                name, [0, 0, 0.1], [0.1, 0.2, 0.6], 1.5, parentObjectUniqueId=robot, parentLinkIndex=link
            )
            named = link


if __name__ == "__main__":
    main(window=wants_window())
