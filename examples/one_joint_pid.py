"""A PID controller swings the one-joint arm up to an angle with torque alone.

Proportional and derivative action leave the arm hanging below its target, for at rest only an error
can hold gravity; the integral takes over that part and closes the gap.
"""

import pybullet as p
from carom.examples import robot_file

ARM = robot_file("one_joint_arm.urdf")
SHOULDER = 0
MAX_TORQUE = 30.0


class PID:
    """Torque from an angle error; the integral stands still while the torque is at its limit."""

    def __init__(self, kp, ki, kd):
        self.kp, self.ki, self.kd = kp, ki, kd
        self.integral = 0.0

    def torque(self, error, velocity, dt):
        integral = self.integral + self.ki * error * dt
        wanted = self.kp * error + integral - self.kd * velocity
        torque = max(-MAX_TORQUE, min(MAX_TORQUE, wanted))
        if torque == wanted:
            self.integral = integral
        return torque


def load_arm(time_step):
    p.setGravity(0, 0, -9.81)
    p.setTimeStep(time_step)
    arm = p.loadURDF(ARM, useFixedBase=True)
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    return arm


def swing(arm, controller, target, steps, time_step):
    """Let the controller bring the arm from hanging to the target; the angles and the torques."""
    p.resetJointState(arm, SHOULDER, targetValue=0, targetVelocity=0)
    angles, torques = [], []
    for _ in range(steps):
        angle, velocity = p.getJointState(arm, SHOULDER)[:2]
        torque = controller.torque(target - angle, velocity, time_step)
        p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=torque)
        p.stepSimulation()
        angles.append(p.getJointState(arm, SHOULDER)[0])
        torques.append(torque)
    return angles, torques


def main(duration=4.0, target=1.2, time_step=1 / 240):
    p.connect(p.DIRECT)
    arm = load_arm(time_step)
    steps = round(duration / time_step)
    record = {"time": [(step + 1) * time_step for step in range(steps)], "target": [target] * steps}
    for name, ki in (("PD", 0), ("PID", 60)):
        record[name], record["torque of " + name] = swing(
            arm, PID(kp=40, ki=ki, kd=8), target, steps, time_step
        )
        print(f"{name:3}: {record[name][-1]:.4f} rad, the target is {target:g} rad")
    p.disconnect()
    return record


if __name__ == "__main__":
    main()
