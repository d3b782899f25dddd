"""Which torque holds an arm up against gravity? At angle θ it is m·g·r·sin θ; here it is tried out.

A constant torque is applied in every step, the joint's damping takes the swing out, and the arm
comes to rest where gravity and the torque balance. The slider says at which angle that is to be.
"""

import math

import pybullet as p
from carom.examples import robot_file
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0
GRAVITY = 9.81


def main(duration=10.0, angle=0.5, window=False):
    connect(window)
    p.resetDebugVisualizerCamera(3, 30, -20, [0, 0, 1])
    p.setGravity(0, 0, -GRAVITY)
    arm = p.loadURDF(ARM, useFixedBase=True)
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.changeDynamics(arm, SHOULDER, jointDamping=2.0)

    mass = p.getDynamicsInfo(arm, SHOULDER)[0]
    centre_of_mass = p.getDynamicsInfo(arm, SHOULDER)[3]
    radius = math.hypot(centre_of_mass[0], centre_of_mass[2])
    wanted = slider("angle [rad]", -1.5, 1.5, angle)

    record = {"time": [], "angle": [], "balance": []}
    for step in steps(duration, window):
        angle = wanted()
        torque = mass * GRAVITY * radius * math.sin(angle)
        p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=torque)
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        record["angle"].append(p.getJointState(arm, SHOULDER)[0])
        record["balance"].append(angle)

    print(f"{mass:g} kg at {radius:g} m: {torque:.3f} N m should hold {angle:.4f} rad")
    print(f"the arm rests at {record['angle'][-1]:.4f} rad")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 10)
