"""The first script of the manual: a robot falls on a plane."""

import pybullet as p
import pybullet_data


def main(steps: int = 240) -> list[float]:
    physics_client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    p.loadURDF("plane.urdf")
    start_orientation = p.getQuaternionFromEuler([0, 0, 0])
    box = p.loadURDF("r2d2.urdf", [0, 0, 1], start_orientation)
    heights: list[float] = []
    for _ in range(steps):
        p.stepSimulation()
        position, orientation = p.getBasePositionAndOrientation(box)
        roll, pitch, _yaw = p.getEulerFromQuaternion(orientation)
        assert abs(roll) < 1 and abs(pitch) < 1
        heights.append(position[2])
    p.disconnect(physics_client)
    return heights


if __name__ == "__main__":
    print(main()[-1])
