"""Soft bodies to time, for engines with PyBullet's interface."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pybullet as p

_IN_CUBE = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))
_FINGERS, _GRASP_TARGET = (9, 10), 11


def cloth_text(side: int, size: float, down: bool = False) -> str:
    """A square with so many nodes along each side, level or hanging from y = z = 0, as an OBJ file."""
    step = size / (side - 1)
    nodes = [(i * step - size / 2, j * step) for j in range(side) for i in range(side)]
    lines = [f"v {x} 0 {-y}" if down else f"v {x} {y - size / 2} 0" for x, y in nodes]
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i + 1
            lines += [f"f {a} {a + 1} {a + side + 1}", f"f {a} {a + side + 1} {a + side}"]
    return "\n".join(lines) + "\n"


def cuboid_text(size: float, cells: Sequence[int]) -> str:
    """A cube of tetrahedra, six in each cell, as a VTK file."""
    counts = [count + 1 for count in cells]
    points = [
        " ".join(str(size * (at / count - 0.5)) for at, count in zip((i, j, k), cells, strict=True))
        for k in range(counts[2])
        for j in range(counts[1])
        for i in range(counts[0])
    ]
    tetras = []
    for k in range(cells[2]):
        for j in range(cells[1]):
            for i in range(cells[0]):
                corner = [
                    ((k + (bit >> 2)) * counts[1] + j + (bit >> 1 & 1)) * counts[0] + i + (bit & 1)
                    for bit in range(8)
                ]
                tetras += ["4 " + " ".join(str(corner[bit]) for bit in four) for four in _IN_CUBE]
    lines = ["# vtk DataFile Version 2.0", "cube", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(points)} double", *points, f"CELLS {len(tetras)} {5 * len(tetras)}", *tetras]
    lines += [f"CELL_TYPES {len(tetras)}", *["10"] * len(tetras)]
    return "\n".join(lines) + "\n"


def load(name: str, text: str, position: Sequence[float], **options: Any) -> int:
    """A soft body of a mesh that is not in a file yet."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / name
        path.write_text(text)
        return p.loadSoftBody(str(path), basePosition=list(position), **options)


def start() -> None:
    """An empty deformable world."""
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -9.81)


def cloth_on_a_ball(side: int) -> None:
    """A square of 1 m on a ball that is fixed."""
    start()
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.3)
    p.createMultiBody(0, ball, basePosition=[0, 0, 0.3])
    load(
        "cloth.obj", cloth_text(side, 1.0), [0, 0, 0.63], mass=1, collisionMargin=0.02, useMassSpring=1,
        springElasticStiffness=40, springDampingStiffness=0.1, springDampingAllDirections=1,
        frictionCoeff=0.5,
    )  # fmt: skip


def soft_cube(plane: str, cells: Sequence[int]) -> None:
    """A cube of 0.4 m on a plane."""
    start()
    p.loadURDF(plane)
    load(
        "cube.vtk", cuboid_text(0.4, cells), [0, 0, 0.21], mass=4, useNeoHookean=1, NeoHookeanMu=1500,
        NeoHookeanLambda=1500, NeoHookeanDamping=0.05, collisionMargin=0.006, frictionCoeff=0.5,
    )  # fmt: skip


def towel_in_a_gripper(panda_file: str, home: Sequence[float], joints: Sequence[int], side: int) -> None:
    """A towel of 16 cm whose upper edge the Panda holds."""
    start()
    panda = p.loadURDF(panda_file, useFixedBase=True)
    for joint, position in zip(joints, home, strict=True):
        p.resetJointState(panda, joint, position)
    for finger in _FINGERS:
        p.resetJointState(panda, finger, 0.01)
        p.changeDynamics(panda, finger, lateralFriction=1.0)
        p.setJointMotorControl2(panda, finger, p.POSITION_CONTROL, 0.0, force=20, maxVelocity=0.1)
    state = p.getLinkState(panda, _GRASP_TARGET)
    assert state is not None
    x, y, z = state[0]
    towel = load(
        "towel.obj", cloth_text(side, 0.16, down=True), [x, y, z + 0.02], mass=0.1, collisionMargin=0.003,
        useMassSpring=1, springElasticStiffness=100, springDampingStiffness=0.02, frictionCoeff=1,
    )  # fmt: skip
    pins = [p.createSoftBodyAnchor(towel, node, -1, -1) for node in (0, side - 1)]
    for _ in range(60):
        p.stepSimulation()
    for pin in pins:
        p.removeConstraint(pin)
