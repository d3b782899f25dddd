"""Why does my joint not swing? Every joint starts with a motor that holds it; force 0 sets it free.

Two arms start side by side, lifted by 1 rad. One keeps its default motor and stays up; the other's
motor is switched off and it falls and swings.
"""

from pathlib import Path

import pybullet as p

ARM = str(Path(__file__).parent / "robots" / "one_joint_arm.urdf")
SHOULDER = 0
TIME_STEP = 1 / 240


def main(duration=4.0):
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    held = p.loadURDF(ARM, basePosition=[0, 0, 0], useFixedBase=True)
    free = p.loadURDF(ARM, basePosition=[0, 1, 0], useFixedBase=True)
    for arm in (held, free):
        p.resetJointState(arm, SHOULDER, targetValue=1.0)

    p.setJointMotorControl2(free, SHOULDER, p.VELOCITY_CONTROL, force=0)

    record = {"time": [], "default motor": [], "motor off": []}
    for step in range(round(duration / TIME_STEP)):
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        record["default motor"].append(p.getJointState(held, SHOULDER)[0])
        record["motor off"].append(p.getJointState(free, SHOULDER)[0])

    print(f"after {duration:g} s: {record['default motor'][-1]:+.3f} rad with the default motor,")
    print(f"             {record['motor off'][-1]:+.3f} rad without")
    p.disconnect()
    return record


if __name__ == "__main__":
    main()
