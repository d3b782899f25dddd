"""Saving and restoring: the same throw again and again, to the last bit, with another push each time."""

import pybullet as p
import pybullet_data


def throw(ball, push, steps):
    p.applyExternalForce(ball, -1, [push, 0, 0], p.getBasePositionAndOrientation(ball)[0], p.WORLD_FRAME)
    for _ in range(steps):
        p.stepSimulation()
    return p.getBasePositionAndOrientation(ball)[0]


def main(steps=240):
    p.connect(p.DIRECT)
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
        ends.append(throw(ball, push, steps))
        print(f"pushed with {push} N: {ends[-1][0]:.6f} m far")
    # A state holds positions, velocities and contacts; not gravity, and not what bodies are made of.
    p.removeState(start)
    p.disconnect()
    return {"ends": ends}


if __name__ == "__main__":
    main()
