"""A rover and a car drive: one turns by the speeds of its sides, the other by its front wheels.

In the window you drive both: the sliders are the speed and how far to turn.
"""

import math

from camera import picture

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, connect, slider, steps, wants_window

ROVER_LEFT, ROVER_RIGHT = (2, 4), (3, 5)
CAR_REAR, CAR_FRONT, CAR_HINGES = (2, 3), (5, 7), (4, 6)


def load():
    """The floor and the two vehicles, side by side."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    rover = p.loadURDF("husky/husky.urdf", [0, 0.8, 0.02])
    car = p.loadURDF("racecar/racecar.urdf", [0, -0.8, 0.02])
    for wheel in CAR_FRONT:
        p.setJointMotorControl2(car, wheel, p.VELOCITY_CONTROL, force=0)
    return rover, car


def drive_rover(rover, left, right):
    for wheels, speed in ((ROVER_LEFT, left), (ROVER_RIGHT, right)):
        for wheel in wheels:
            p.setJointMotorControl2(rover, wheel, p.VELOCITY_CONTROL, targetVelocity=speed, force=30)


def drive_car(car, speed, steering):
    for wheel in CAR_REAR:
        p.setJointMotorControl2(car, wheel, p.VELOCITY_CONTROL, targetVelocity=speed, force=5)
    for hinge in CAR_HINGES:
        p.setJointMotorControl2(car, hinge, p.POSITION_CONTROL, steering, force=10)


def drive_by_hand(rover, car):
    """The sliders drive both vehicles until ESC."""
    speed, turn = slider("speed", -1, 1, 0.5), slider("turn", -1, 1, 0)
    for _ in steps(math.inf, True):
        pace, side = speed(), turn()
        drive_rover(rover, 6 * (pace - side / 2), 6 * (pace + side / 2))
        drive_car(car, 20 * pace, 0.4 * side)
        p.stepSimulation()


def main(duration=6.0, window=False):
    """Straight on for a third of the time, then a curve; the ways of both."""
    connect(window)
    rover, car = load()
    record = {"rover": [], "car": []}
    if window:
        drive_by_hand(rover, car)
        p.disconnect()
        return record
    end = round(duration / TIME_STEP)
    for step in steps(duration, window):
        turning = step > end / 3
        drive_rover(rover, 2 if turning else 6, 6)
        drive_car(car, 20, -0.3 if turning else 0)
        p.stepSimulation()
        record["rover"].append(p.getBasePositionAndOrientation(rover)[0][:2])
        record["car"].append(p.getBasePositionAndOrientation(car)[0][:2])
        if step == end // 3:
            record["image"] = picture([record["car"][-1][0] + 0.3, -0.1, 0.2], 2.6, yaw=60)
    for name in ("rover", "car"):
        print(f"the {name} is at {record[name][-1][0]:.2f}, {record[name][-1][1]:.2f} m")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window())
