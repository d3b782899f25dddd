"""Ten cubes stand on each other until a ball hits them; in the window a button throws it."""

import math

from camera import picture

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, button, connect, slider, steps, wants_window

EDGE = 0.1
CUBES = 10


def load():
    """The floor and the tower."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    return [
        p.loadURDF("cube.urdf", [0, 0, EDGE * (level + 0.5)], globalScaling=EDGE) for level in range(CUBES)
    ]


def throw_ball(speed=5):
    """A heavy ball on its way to the middle of the tower."""
    ball = p.loadURDF("sphere2red.urdf", [-1.2, 0, 0.6], globalScaling=0.2)
    p.changeDynamics(ball, -1, mass=5)
    p.resetBaseVelocity(ball, [speed, 0, 1])


def run(cubes, record, duration, window=False):
    """Step for a time and note the height of every cube; in the window balls are thrown."""
    speed, throw = slider("speed of the ball [m/s]", 1, 10, 5), button("throw a ball")
    for _ in steps(duration, window):
        if throw():
            throw_ball(speed())
        p.stepSimulation()
        heights = [p.getBasePositionAndOrientation(cube)[0][2] for cube in cubes]
        record["time"].append((len(record["time"]) + 1) * TIME_STEP)
        record["heights"].append(heights)


def main(duration=2.0, window=False):
    """The tower stands for a while and falls for a while; heights and a picture of each."""
    connect(window)
    cubes = load()
    record = {"time": [], "heights": []}
    if window:
        run(cubes, record, math.inf, window=True)
        p.disconnect()
        return record
    run(cubes, record, duration)
    record["image"] = picture([0, 0, 0.5], 1.7)
    print(f"top of the tower after {duration} s: {record['heights'][-1][-1] + EDGE / 2:.4f} m")
    throw_ball()
    run(cubes, record, duration)
    record["image after"] = picture([0.3, 0, 0.2], 1.9)
    print(f"highest cube after the ball: {max(record['heights'][-1]):.3f} m")
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window())
