"""The four ways to drive a joint, side by side on four copies of the same arm.

POSITION_CONTROL goes to an angle, VELOCITY_CONTROL keeps a speed, TORQUE_CONTROL pushes with a
torque that lasts for one step only, and PD_CONTROL pushes like a spring and a damper do.
"""

from pathlib import Path

import pybullet as p

ARM = str(Path(__file__).parent / "robots" / "one_joint_arm.urdf")
SHOULDER = 0
TIME_STEP = 1 / 240


def main(duration=3.0):
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    position, velocity, torque, pd = (
        p.loadURDF(ARM, basePosition=[0, i, 0], useFixedBase=True) for i in range(4)
    )

    # These motors keep their targets until they are given others.
    p.setJointMotorControl2(position, SHOULDER, p.POSITION_CONTROL, targetPosition=1.0, force=50)
    p.setJointMotorControl2(velocity, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=0.5, force=50)
    # Torque and PD control come on top of the default motor, so that goes off first.
    for arm in (torque, pd):
        p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.setJointMotorControl2(
        pd, SHOULDER, p.PD_CONTROL, targetPosition=1.0, positionGain=60, velocityGain=8, force=50
    )

    arms = {"POSITION": position, "VELOCITY": velocity, "TORQUE": torque, "PD": pd}
    record = {"time": [], **{mode: [] for mode in arms}}
    for step in range(round(duration / TIME_STEP)):
        p.setJointMotorControl2(torque, SHOULDER, p.TORQUE_CONTROL, force=5.0)
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        for mode, arm in arms.items():
            record[mode].append(p.getJointState(arm, SHOULDER)[0])

    print("mode       angle [rad]  speed [rad/s]  motor torque [N m]")
    for mode, arm in arms.items():
        angle, speed, _, motor_torque = p.getJointState(arm, SHOULDER)
        print(f"{mode:9} {angle:12.4f} {speed:14.4f} {motor_torque:19.3f}")
    p.disconnect()
    return record


if __name__ == "__main__":
    main()
