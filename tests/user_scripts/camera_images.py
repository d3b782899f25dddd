"""Colour, depth in metres and masks from a camera that goes round a duck."""

import numpy as np
from numpy.typing import NDArray

import pybullet as p
import pybullet_data

NEAR, FAR, FIELD_OF_VIEW = 0.05, 5.0, 60.0


def metres(depth: NDArray[np.float32]) -> NDArray[np.float32]:
    return FAR * NEAR / (FAR - (FAR - NEAR) * depth)


def look(yaw: float, size: int) -> tuple[NDArray[np.uint8], NDArray[np.float32], NDArray[np.int32]]:
    view = p.computeViewMatrixFromYawPitchRoll([0, 0, 0.2], 1.0, yaw, -30.0, 0.0, 2)
    projection = p.computeProjectionMatrixFOV(FIELD_OF_VIEW, 1.0, NEAR, FAR)
    _, _, rgba, depth, mask = p.getCameraImage(
        size, size, view, projection, shadow=1, renderer=p.ER_TINY_RENDERER
    )
    return rgba[:, :, :3], metres(depth), mask


def main(size: int = 32) -> list[float]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    cube = p.loadURDF("cube_small.urdf", [0, 0, 0.2], globalScaling=4)
    p.changeVisualShape(cube, -1, rgbaColor=[1, 0, 0, 1])
    distances: list[float] = []
    for yaw in range(0, 360, 90):
        colour, depth, mask = look(float(yaw), size)
        assert colour.shape == (size, size, 3)
        distances.append(float(depth[mask == cube].min()))
    p.disconnect()
    return distances


if __name__ == "__main__":
    print(main(256))
