"""Saving and restoring: the same throw again and again, to the last bit, with another push each time."""

import pybullet as p
import pybullet_data
from carom.examples.window import button, connect, slider, steps, wants_window


def throw(ball, push, count):
    p.applyExternalForce(ball, -1, [push, 0, 0], p.getBasePositionAndOrientation(ball)[0], p.WORLD_FRAME)
    for _ in range(count):
        p.stepSimulation()
    return p.getBasePositionAndOrientation(ball)[0]


def play(ball, start):
    """The button restores the state and pushes with the force of the slider, until ESC."""
    push, again = slider("push [N]", 0, 40, 10), button("again")
    for _ in steps(float("inf"), True):
        if again():
            p.restoreState(start)
            throw(ball, push(), 1)
        p.stepSimulation()


def main(count=240, window=False):
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    p.loadURDF("plane.urdf")
    ball = p.loadURDF("sphere_small.urdf", [0, 0, 0.5])
    for _ in range(10):
        p.stepSimulation()
    start = p.saveState()

    ends = []
    for push in (10, 20, 10):
        p.restoreState(start)
        ends.append(throw(ball, push, count))
        print(f"pushed with {push} N: {ends[-1][0]:.6f} m far")
    if window:
        play(ball, start)
        p.disconnect()
        return {"ends": ends}
    # A state holds positions, velocities and contacts; not gravity, and not what bodies are made of.
    p.removeState(start)
    p.disconnect()
    return {"ends": ends}


if __name__ == "__main__":
    main(window=wants_window())
