"""Scenes for comparing images with PyBullet's; this file runs under PyBullet as well as under Carom."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

ASSETS = Path(__file__).parents[2] / "src" / "pybullet_data"
WIDTH, HEIGHT = 96, 72
FAR = 20.0

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Scene:
    """What is built, and where the camera stands.

    The near plane of scenes with shadows is at 1 cm: PyBullet's shadows darken everything when it is
    farther away.
    """

    name: str
    build: Callable[[Any], None]
    eye: Vector
    target: Vector
    field_of_view: float
    near: float = 0.1
    shadow: int = 0
    alike: float = 0.97
    """The fraction of pixels that must have PyBullet's colour."""


def panda(p: Any) -> None:
    p.loadURDF(str(ASSETS / "plane.urdf"))
    arm = p.loadURDF(str(ASSETS / "franka_panda" / "panda.urdf"), useFixedBase=1)
    for joint, angle in enumerate((0.0, -0.5, 0.2, -2.0, 0.1, 1.7, 0.8)):
        p.resetJointState(arm, joint, angle)


def r2d2(p: Any) -> None:
    p.loadURDF(str(ASSETS / "plane.urdf"))
    p.loadURDF(str(ASSETS / "r2d2.urdf"), [0, 0, 0.5])


def table(p: Any) -> None:
    p.loadURDF(str(ASSETS / "plane.urdf"))
    p.loadURDF(str(ASSETS / "table" / "table.urdf"))
    p.loadURDF(str(ASSETS / "cube_small.urdf"), [0, 0, 0.65])
    p.loadURDF(str(ASSETS / "duck_vhacd.urdf"), [0.3, 0.2, 0.65])
    p.loadURDF(str(ASSETS / "soccerball.urdf"), [-0.4, 0.1, 0.9], globalScaling=0.3)


def kuka(p: Any) -> None:
    p.loadURDF(str(ASSETS / "plane.urdf"))
    p.loadURDF(str(ASSETS / "kuka_iiwa" / "model.urdf"), useFixedBase=1)
    p.loadURDF(str(ASSETS / "tray" / "traybox.urdf"), [0.6, 0, 0])


def close_by(p: Any) -> None:
    """A cube that reaches through the near plane, and a floor that reaches behind the camera."""
    p.loadURDF(str(ASSETS / "plane.urdf"))
    p.loadURDF(str(ASSETS / "cube.urdf"), [0.5, 0.4, 0.2], p.getQuaternionFromEuler([0, 0, 0.6]))


def painted(p: Any) -> None:
    """Changed colours and textures, a hidden cube, one that has fallen for a while, and one removed."""
    p.setGravity(0, 0, -10)
    p.loadURDF(str(ASSETS / "plane.urdf"))
    cubes = [p.loadURDF(str(ASSETS / "cube.urdf"), [i - 2, 0, 0.7], globalScaling=0.6) for i in range(5)]
    texture = p.loadTexture(str(ASSETS / "uvmap.png"))
    p.changeVisualShape(cubes[0], -1, rgbaColor=[0.9, 0.2, 0.1, 1])
    p.changeVisualShape(cubes[1], -1, textureUniqueId=texture)
    p.changeVisualShape(cubes[2], -1, rgbaColor=[0, 1, 0, 0])
    p.changeVisualShape(cubes[3], -1, textureUniqueId=-1, rgbaColor=[0.5, 0.5, 1, 1])
    p.removeBody(cubes[4])
    p.resetBaseVelocity(cubes[0], [0, 3, 4], [2, 3, 1])
    for _ in range(20):
        p.stepSimulation()


def soft(p: Any) -> None:
    """A solid and a cloth as they are loaded, and two with another texture and another colour.

    The squares of solids begin at the origin of the world, and here at that of the body.
    """
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    elastic = {"mass": 1.0, "useNeoHookean": 1, "NeoHookeanMu": 400, "NeoHookeanLambda": 600}
    springs = {"mass": 1.0, "useMassSpring": 1, "springElasticStiffness": 40}
    solid, cloth = str(ASSETS / "torus.vtk"), str(ASSETS / "cloth_z_up.obj")
    p.loadSoftBody(solid, basePosition=[0, 0, 0.2], scale=0.5, **elastic)
    p.loadSoftBody(cloth, basePosition=[1, 0, 0.3], scale=0.6, **springs)
    others = [
        p.loadSoftBody(solid, basePosition=[0, 0, 1], scale=0.5, **elastic),
        p.loadSoftBody(cloth, basePosition=[1, 1.5, 0.3], scale=0.6, **springs),
    ]
    texture = p.loadTexture(str(ASSETS / "checker_blue.png"))
    for body in others:
        p.changeVisualShape(body, -1, textureUniqueId=texture, rgbaColor=[1, 0.8, 0.5, 1])
    # Before the first step PyBullet shows them as they are in the file.
    p.stepSimulation()


def landscapes(p: Any) -> None:
    """Fields of heights with the checks they have, and with a texture that is the same on no two sides."""
    waves = [0.05 * ((3 * place) % 7) for place in range(42)]
    for x in (-1.6, 1.6):
        shape = p.createCollisionShape(
            p.GEOM_HEIGHTFIELD,
            meshScale=[0.5, 0.4, 1],
            heightfieldData=waves,
            numHeightfieldRows=6,
            numHeightfieldColumns=7,
        )
        body = p.createMultiBody(0, shape, -1, [x, 0, 0])
    p.changeVisualShape(body, -1, textureUniqueId=p.loadTexture(str(ASSETS / "uvmap.png")))


def textured(p: Any) -> None:
    """Primitive shapes of many sizes and tilts under a texture that is the same on no two places."""
    texture = p.loadTexture(str(ASSETS / "uvmap.png"))
    shapes = (
        {"shapeType": p.GEOM_SPHERE, "radius": 0.5},
        {"shapeType": p.GEOM_SPHERE, "radius": 0.3},
        {"shapeType": p.GEOM_BOX, "halfExtents": [0.4, 0.2, 0.3]},
        {"shapeType": p.GEOM_CAPSULE, "radius": 0.3, "length": 0.5},
        {"shapeType": p.GEOM_CAPSULE, "radius": 0.1, "length": 0.8},
        {"shapeType": p.GEOM_CAPSULE, "radius": 0.4, "length": 0.1},
        {"shapeType": p.GEOM_CYLINDER, "radius": 0.4, "length": 0.8},
        {"shapeType": p.GEOM_CYLINDER, "radius": 0.5, "length": 0.02},
        {"shapeType": p.GEOM_CYLINDER, "radius": 0.05, "length": 1.0},
    )
    for i, shape in enumerate(shapes):
        turned = p.getQuaternionFromEuler([0.4 * i, 0.7 * i, 0.3 * i])
        look = p.createVisualShape(**shape, visualFramePosition=[0.1, 0, 0], visualFrameOrientation=turned)
        body = p.createMultiBody(0, -1, look, [1.1 * (i % 3 - 1), 0, 1.1 * (i // 3 - 1)])
        p.changeVisualShape(body, -1, textureUniqueId=texture)
    # Planes lie flat, whatever is asked for.
    plane = p.createVisualShape(p.GEOM_PLANE, planeNormal=[0.48, -0.6, 0.64])
    body = p.createMultiBody(0, -1, plane, [0.3, 0.2, -1.7])
    p.changeVisualShape(body, -1, textureUniqueId=texture)


def untextured(p: Any) -> None:
    """Collision shapes without looks, their frames beside the centre of mass, and tilted planes."""
    for i, shape in enumerate(
        (
            {"shapeType": p.GEOM_SPHERE, "radius": 0.5},
            {"shapeType": p.GEOM_CAPSULE, "radius": 0.3, "height": 0.5},
            {"shapeType": p.GEOM_CYLINDER, "radius": 0.4, "height": 0.5},
        )
    ):
        p.createMultiBody(
            1,
            p.createCollisionShape(**shape),
            -1,
            [1.1 * (i - 1), 0, 0],
            p.getQuaternionFromEuler([0.4, 0.7 * i, 0.3]),
            baseInertialFramePosition=[0.1, 0, 0],
            baseInertialFrameOrientation=p.getQuaternionFromEuler([0, 0.3, 0]),
        )
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, planeNormal=[0.48, -0.6, 0.64]), -1, [0, 0, -1])
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE, planeNormal=[0, -1, 0]), -1, [0, 2, 0])


def leaning_normals(p: Any) -> None:
    """STL files: fingers of a gripper, and a pyramid whose normals lean, are long, or turn inwards."""
    for name, place in (("l_finger.stl", [-0.6, 0, 0]), ("l_finger_tip.stl", [0.6, 0, 0])):
        look = p.createVisualShape(p.GEOM_MESH, fileName=str(ASSETS / name), meshScale=[12, 12, 12])
        p.createMultiBody(0, -1, look, place, p.getQuaternionFromEuler([0.3, 0.5, 0.4]))
    around = [(0.5, 0.5, 0.0), (-0.5, 0.5, 0.0), (-0.5, -0.5, 0.0), (0.5, -0.5, 0.0)]
    normals = [(0.2, 0.9, 0.6), (-3.0, 1.0, 2.0), (0.1, 0.05, -0.2), (0.9, -0.5, 0.1)]
    sides = [
        struct.pack("<12fH", *normals[i], *around[i], *around[(i + 1) % 4], 0.0, 0.0, 0.6, 0)
        for i in range(4)
    ]
    with TemporaryDirectory() as folder:
        file = Path(folder) / "pyramid.stl"
        file.write_bytes(bytes(80) + struct.pack("<I", len(sides)) + b"".join(sides))
        for place, scale in (([0, 0.9, 0], 1.0), ([0, -0.7, 0.2], 0.6)):
            look = p.createVisualShape(p.GEOM_MESH, fileName=str(file), meshScale=[scale] * 3)
            p.createMultiBody(0, -1, look, place, p.getQuaternionFromEuler([0, 0, 1.9]))


SCENES = (
    Scene("panda", panda, (1.2, -0.8, 1.0), (0.2, 0.0, 0.4), 50),
    Scene("r2d2", r2d2, (2.0, -2.0, 1.5), (0.0, 0.0, 0.4), 50),
    Scene("table", table, (0.9, -0.9, 1.3), (0.0, 0.0, 0.6), 60, near=0.01, shadow=1),
    Scene("kuka", kuka, (1.2, 0.8, 0.9), (0.2, 0.0, 0.4), 60),
    Scene("close_by", close_by, (0.0, 0.0, 0.3), (0.0, 1.0, 0.2), 80),
    Scene("painted", painted, (1.5, -2.5, 1.8), (-0.3, 0.0, 0.4), 60),
    Scene("landscapes", landscapes, (0.3, -2.6, 3.0), (0.0, 0.0, 0.0), 60),
    Scene("textured", textured, (0.13, -4.1, 1.07), (0.03, 0.0, -0.11), 45, alike=0.996),
    Scene("untextured", untextured, (0.13, -3.1, 1.07), (0.03, 0.0, -0.11), 45, alike=0.996),
    Scene("leaning_normals", leaning_normals, (0.4, -2.4, 2.0), (0.0, 0.0, 0.2), 50, alike=0.996),
    Scene("soft", soft, (0.4, -2.4, 2.0), (0.4, 0.2, 0.5), 50),
)


def take_picture(p: Any, scene: Scene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Colours, depth and labels of a scene in a client that is connected."""
    p.resetSimulation()
    scene.build(p)
    view = p.computeViewMatrix(scene.eye, scene.target, (0.0, 0.0, 1.0))
    projection = p.computeProjectionMatrixFOV(scene.field_of_view, WIDTH / HEIGHT, scene.near, FAR)
    _, _, rgba, depth, label = p.getCameraImage(
        WIDTH,
        HEIGHT,
        view,
        projection,
        shadow=scene.shadow,
        renderer=p.ER_TINY_RENDERER,
        flags=p.ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX,
    )
    return rgba, depth, label
