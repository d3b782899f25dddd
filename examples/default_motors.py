"""Why does my joint not swing? Every joint starts with a motor that holds it; force 0 sets it free.

Two arms start side by side, lifted by 1 rad. One keeps its default motor and stays up; the other's
motor is switched off and it falls and swings; the slider gives it back some force, which acts as friction.
"""

import math

import pybullet as p
from carom.examples import robot_file
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0


def main(duration=4.0, window=False):
    connect(window)
    p.resetDebugVisualizerCamera(4, 60, -15, [0, 0.5, 1])
    p.setGravity(0, 0, -9.81)
    held = p.loadURDF(ARM, basePosition=[0, 0, 0], useFixedBase=True)
    free = p.loadURDF(ARM, basePosition=[0, 1, 0], useFixedBase=True)
    for arm in (held, free):
        p.resetJointState(arm, SHOULDER, targetValue=1.0)

    force = slider("force of the second motor [N m]", 0, 20, 0)
    record = {"time": [], "default motor": [], "motor off": []}
    for step in steps(duration, window):
        p.setJointMotorControl2(free, SHOULDER, p.VELOCITY_CONTROL, force=force())
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        record["default motor"].append(p.getJointState(held, SHOULDER)[0])
        record["motor off"].append(p.getJointState(free, SHOULDER)[0])

    print(f"after {record['time'][-1]:g} s: {record['default motor'][-1]:+.3f} rad with the default motor,")
    print(f"             {record['motor off'][-1]:+.3f} rad without")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 4)
