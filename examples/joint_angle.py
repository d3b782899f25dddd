"""A joint's angle, live beside the joint: a text that is carried by the link."""

import math

import pybullet as p
from carom.examples import robot_file
from carom.examples.window import connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0


def main(duration=math.inf, window=True):
    connect(window)
    p.setGravity(0, 0, -9.81)
    p.resetDebugVisualizerCamera(3, 30, -20, [0, 0, 1])
    arm = p.loadURDF(ARM, useFixedBase=True)
    target = slider("target [degrees]", -180, 180, 65)

    label, shown = -1, []
    for step in steps(duration, window):
        goal = math.radians(target())
        p.setJointMotorControl2(arm, SHOULDER, p.POSITION_CONTROL, goal, force=50, maxVelocity=1)
        p.stepSimulation()
        # A text is a message to the page: ten times a second is enough to read.
        if step % 24 == 0:
            angle = math.degrees(p.getJointState(arm, SHOULDER)[0])
            place = {"parentObjectUniqueId": arm, "parentLinkIndex": SHOULDER}
            more = {"replaceItemUniqueId": label} if label >= 0 else {}
            label = p.addUserDebugText(f"{angle:.1f}°", [0.1, 0, 0], [0.1, 0.2, 0.6], 1.5, **place, **more)
            shown.append(angle)
    p.disconnect()
    return {"shown": shown}


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 3)
