"""R2D2 falls on its wheels, and balls of three restitutions fall beside it; in the window again and again."""

import math

from camera import picture

import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, button, connect, slider, steps, wants_window

RESTITUTIONS = (0.0, 0.5, 0.9)


def load():
    """The floor, R2D2 two metres above it, and a ball for each restitution."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    floor = p.loadURDF("plane.urdf")
    p.changeDynamics(floor, -1, restitution=1)
    bodies = {"R2D2": p.loadURDF("r2d2.urdf", [0, 0, 2])}
    for number, restitution in enumerate(RESTITUTIONS):
        ball = p.loadURDF("sphere_small.urdf", [0.8, 0.4 * number - 0.4, 1.5], globalScaling=3)
        # The restitutions of both bodies are multiplied, so the floor's is 1.
        p.changeDynamics(ball, -1, restitution=restitution)
        bodies[f"restitution {restitution}"] = ball
    return bodies


def lift(bodies, height):
    """Puts everything back into the air: R2D2 at a height, the balls half a metre lower."""
    for number, body in enumerate(bodies.values()):
        place = [0.8, 0.4 * number - 0.8, height - 0.5] if number else [0, 0, height]
        p.resetBasePositionAndOrientation(body, place, [0, 0, 0, 1])
        p.resetBaseVelocity(body, [0, 0, 0], [0, 0, 0])


def main(duration=3.0, window=False):
    """Let everything fall; the heights over time."""
    connect(window)
    bodies = load()
    height, again = slider("height [m]", 1, 4, 2), button("drop again")
    record = {"time": []} | {name: [] for name in bodies}
    for step in steps(duration, window):
        if again():
            lift(bodies, height())
        p.stepSimulation()
        record["time"].append((step + 1) * TIME_STEP)
        for name, body in bodies.items():
            record[name].append(p.getBasePositionAndOrientation(body)[0][2])
    for name in bodies:
        print(f"{name:16}: highest after the first second {max(record[name][240:], default=0):.2f} m")
    if not window:
        record["image"] = picture([0.4, 0, 0.5], 2.5)
    p.disconnect()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=math.inf if wants_window() else 3)
