"""Tune a PID controller by hand: sliders for the gains and the target angle, ESC to quit.

The arm starts at rest; move the sliders in the window and watch it follow.
"""

import math
import time

from one_joint_pid import ARM, PID, SHOULDER

import pybullet as p

TIME_STEP = 1 / 240
ESC = 27


def main(duration=math.inf, real_time=True):
    p.connect(p.GUI)
    p.resetDebugVisualizerCamera(
        cameraDistance=3, cameraYaw=30, cameraPitch=-20, cameraTargetPosition=[0, 0, 1]
    )
    p.setGravity(0, 0, -9.81)
    arm = p.loadURDF(ARM, useFixedBase=True)
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)

    kp = p.addUserDebugParameter("kp", 0, 100, 40)
    ki = p.addUserDebugParameter("ki", 0, 100, 60)
    kd = p.addUserDebugParameter("kd", 0, 20, 8)
    target = p.addUserDebugParameter("target [rad]", -math.pi, math.pi, 1.2)

    controller = PID(kp=0, ki=0, kd=0)
    record = {"time": [], "angle": []}
    while p.isConnected() and len(record["time"]) * TIME_STEP < duration:
        if p.getKeyboardEvents().get(ESC, 0) & p.KEY_WAS_TRIGGERED:
            break
        controller.kp, controller.ki, controller.kd = map(p.readUserDebugParameter, (kp, ki, kd))
        angle, velocity = p.getJointState(arm, SHOULDER)[:2]
        error = p.readUserDebugParameter(target) - angle
        torque = controller.torque(error, velocity, TIME_STEP)
        p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=torque)
        p.stepSimulation()
        record["time"].append((len(record["time"]) + 1) * TIME_STEP)
        record["angle"].append(p.getJointState(arm, SHOULDER)[0])
        if real_time:
            time.sleep(TIME_STEP)
    p.disconnect()
    return record


if __name__ == "__main__":
    main()
