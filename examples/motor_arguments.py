"""What each argument of setJointMotorControl2 does: move the sliders and watch the arm and its plot.

Choose the joint under "Plots" to see its angle beside the target.
"""

import math

import pybullet as p
from carom.examples import robot_file
from carom.examples.window import connect, slider, steps, wants_window

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0


def main(duration=math.inf, window=True, **start):
    connect(window)
    p.setGravity(0, 0, -9.81)
    p.resetDebugVisualizerCamera(3, 30, -20, [0, 0, 1])
    arm = p.loadURDF(ARM, useFixedBase=True)
    values = {"targetPosition": 1.2, "targetVelocity": 0, "positionGain": 0.1, "velocityGain": 1, **start}
    position = slider("targetPosition [rad]", -math.pi, math.pi, values["targetPosition"])
    velocity = slider("targetVelocity [rad/s]", -5, 5, values["targetVelocity"])
    kp = slider("positionGain", 0, 1, values["positionGain"])
    kd = slider("velocityGain", 0, 1, values["velocityGain"])
    force = slider("force [N m]", 0, 50, values.get("force", 50))
    fastest = slider("maxVelocity [rad/s]", 0.1, 10, values.get("maxVelocity", 10))

    angles = []
    for _ in steps(duration, window):
        p.setJointMotorControl2(
            arm,
            SHOULDER,
            p.POSITION_CONTROL,
            targetPosition=position(),
            targetVelocity=velocity(),
            positionGain=kp(),
            velocityGain=kd(),
            force=force(),
            maxVelocity=fastest(),
        )
        p.stepSimulation()
        angles.append(p.getJointState(arm, SHOULDER)[0])
    p.disconnect()
    return {"angle": angles}


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 2)
