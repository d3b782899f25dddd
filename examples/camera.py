"""Pictures without a window: a scene of things that come with pybullet_data."""

import numpy as np

import pybullet as p
import pybullet_data


def picture(target, distance, yaw=40, pitch=-20, size=(480, 320)):
    """The scene as seen from a distance, as an array (height, width, 3) of bytes."""
    view = p.computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, 0, 2)
    projection = p.computeProjectionMatrixFOV(45, size[0] / size[1], 0.05, 50)
    pixels = p.getCameraImage(*size, view, projection, shadow=1, lightDirection=[3, 2, 6])[2]
    return np.reshape(np.asarray(pixels, dtype=np.uint8), (size[1], size[0], 4))[:, :, :3]


def main(size=(480, 320)):
    """A table with things on it, and robots beside it."""
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    p.loadURDF("table/table.urdf")
    for name, place in {
        "lego/lego.urdf": [-0.4, -0.3, 0.64],
        "cube_small.urdf": [-0.2, -0.2, 0.65],
        "duck_vhacd.urdf": [0.1, -0.3, 0.63],
        "teddy_vhacd.urdf": [0.2, -0.2, 0.63],
        "random_urdfs/001/001.urdf": [0.5, -0.2, 0.65],
        "r2d2.urdf": [-1.3, 0.2, 0.48],
        "husky/husky.urdf": [1.5, 0.3, 0.0],
        "a1/a1.urdf": [-0.6, -1.1, 0.42],
        "racecar/racecar.urdf": [0.2, -1.2, 0.0],
    }.items():
        p.loadURDF(name, place)
    p.loadURDF("soccerball.urdf", [-1.3, -0.8, 0.12], globalScaling=0.25)
    panda = p.loadURDF("franka_panda/panda.urdf", [0, 0.3, 0.625], useFixedBase=True)
    for joint, angle in enumerate((-1.2, 0.3, 0.0, -1.9, 0.0, 2.2, 0.8)):
        p.resetJointState(panda, joint, angle)
    image = picture([0, -0.2, 0.5], 3.3, yaw=15, size=size)
    p.disconnect()
    print(f"a picture of {image.shape[1]} by {image.shape[0]} pixels")
    return {"image": image}


if __name__ == "__main__":
    main()
