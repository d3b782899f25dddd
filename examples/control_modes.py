"""The four ways to drive a joint, side by side on four copies of the same arm.

POSITION_CONTROL goes to an angle, VELOCITY_CONTROL keeps a speed, TORQUE_CONTROL pushes with a
torque that lasts for one step only, and PD_CONTROL pushes like a spring and a damper do.
"""

import math

import pybullet as p
from carom.examples import robot_file
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0


def main(duration=3.0, window=False):
    connect(window)
    p.resetDebugVisualizerCamera(5, 60, -15, [0, 1.5, 1])
    p.setGravity(0, 0, -9.81)
    position, velocity, torque, pd = (
        p.loadURDF(ARM, basePosition=[0, i, 0], useFixedBase=True) for i in range(4)
    )

    # Torque and PD control come on top of the default motor, so that goes off first.
    for arm in (torque, pd):
        p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)

    angle = slider("angle of POSITION and PD [rad]", -math.pi, math.pi, 1.0)
    speed = slider("speed of VELOCITY [rad/s]", -3, 3, 0.5)
    push = slider("torque of TORQUE [N m]", -10, 10, 5.0)
    arms = {"POSITION": position, "VELOCITY": velocity, "TORQUE": torque, "PD": pd}
    record = {"time": [], **{mode: [] for mode in arms}}
    for step in steps(duration, window):
        # Three of these would last until they are given others; the torque is for this step alone.
        p.setJointMotorControl2(position, SHOULDER, p.POSITION_CONTROL, targetPosition=angle(), force=50)
        p.setJointMotorControl2(velocity, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=speed(), force=50)
        p.setJointMotorControl2(
            pd, SHOULDER, p.PD_CONTROL, targetPosition=angle(), positionGain=60, velocityGain=8, force=50
        )
        p.setJointMotorControl2(torque, SHOULDER, p.TORQUE_CONTROL, force=push())
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        for mode, arm in arms.items():
            record[mode].append(p.getJointState(arm, SHOULDER)[0])

    if p.isConnected():
        print("mode       angle [rad]  speed [rad/s]  motor torque [N m]")
        for mode, arm in arms.items():
            angle, speed, _, motor_torque = p.getJointState(arm, SHOULDER)
            print(f"{mode:9} {angle:12.4f} {speed:14.4f} {motor_torque:19.3f}")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 3)
