"""Which torque holds an arm up against gravity? At angle θ it is m·g·r·sin θ; here it is tried out.

A constant torque is applied in every step, the joint's damping takes the swing out, and the arm
comes to rest where gravity and the torque balance.
"""

import math
from pathlib import Path

import pybullet as p

ARM = str(Path(__file__).parent / "robots" / "one_joint_arm.urdf")
SHOULDER = 0
GRAVITY = 9.81
TIME_STEP = 1 / 240


def main(duration=10.0, angle=0.5):
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -GRAVITY)
    arm = p.loadURDF(ARM, useFixedBase=True)
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.changeDynamics(arm, SHOULDER, jointDamping=2.0)

    mass = p.getDynamicsInfo(arm, SHOULDER)[0]
    centre_of_mass = p.getDynamicsInfo(arm, SHOULDER)[3]
    radius = math.hypot(centre_of_mass[0], centre_of_mass[2])
    torque = mass * GRAVITY * radius * math.sin(angle)

    record = {"time": [], "angle": [], "balance": []}
    for step in range(round(duration / TIME_STEP)):
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
    main()
