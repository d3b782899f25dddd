"""Hulls whose corners both engines list, and that touch a cylinder. Standard library only: both import it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from math import cos, pi, sin
from pathlib import Path
from typing import Any

MESHES = Path(__file__).resolve().parents[2] / "formats" / "data" / "meshes"
_CYLINDER = """<robot name="rod"><link name="rod"><collision><geometry>
<cylinder radius="0.13" length="0.7"/></geometry></collision></link></robot>"""
_POSES = 24


def _numbers(seed: int, count: int) -> list[float]:
    """Numbers from 0 to 1 that look like chance, exact in single precision."""
    found = []
    for _ in range(count):
        seed = (seed * 1103515245 + 12345) % 2**31
        found.append((seed >> 11) / 2**20)
    return found


def _scattered(seed: int, count: int, sizes: tuple[float, float, float]) -> list[list[float]]:
    rows = _numbers(seed, 3 * count)
    return [[size * rows[3 * n + axis] for axis, size in enumerate(sizes)] for n in range(count)]


def _in_layers(count: int) -> list[list[float]]:
    """Points of a lattice, some of them several times: many lie in one plane, or on one line."""
    return [
        [0.25 * int(4 * x), 0.5 * int(4 * y), 0.125 * int(4 * z)]
        for x, y, z in _scattered(5, count, (1, 1, 1))
    ]


def _prism(sides: int) -> list[list[float]]:
    angles = [2 * pi * side / sides for side in range(sides)]
    return [[0.2 * cos(angle), 0.2 * sin(angle), z] for angle in angles for z in (-0.15, 0.15)]


POINTS: dict[str, list[list[float]]] = {
    "scattered": _scattered(1, 60, (1.0, 1.5, 0.75)),
    "scattered, some repeated": [
        point for n, point in enumerate(_scattered(2, 60, (0.5, 0.25, 1.0))) for _ in range(1 + n % 3)
    ],
    "as long as wide": _scattered(3, 40, (1.0, 1.0, 1.0)),
    "in layers": _in_layers(70),
    "prism": _prism(12),
    "box": [[x, y, z] for z in (-0.1, 0.1) for x in (-0.2, 0.2) for y in (-0.3, 0.3)],
    "flat": [[x, y, 0.0] for x, y, _ in _scattered(4, 30, (1.0, 2.0, 1.0))],
}
FILES = ("two_boxes.obj", "wedge.stl")
TOUCHING = ("prism", "box", "in layers")


def _listed(shape: Callable[[Any], int]) -> Callable[[Any], list[list[float]]]:
    def question(p: Any) -> list[list[float]]:
        return [list(corner) for corner in p.getMeshData(p.createMultiBody(0, shape(p)))[1]]

    return question


def _hull(name: str) -> Callable[[Any], int]:
    return lambda p: p.createCollisionShape(p.GEOM_MESH, vertices=POINTS[name])


def _file(name: str) -> Callable[[Any], int]:
    return lambda p: p.createCollisionShape(p.GEOM_MESH, fileName=str(MESHES / name))


def _rod(p: Any) -> list[list[float]]:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "rod.urdf"
        file.write_text(_CYLINDER, encoding="utf-8")
        return [list(corner) for corner in p.getMeshData(p.loadURDF(str(file)))[1]]


CORNERS: dict[str, Callable[[Any], list[list[float]]]] = {
    **{name: _listed(_hull(name)) for name in POINTS},
    **{name: _listed(_file(name)) for name in FILES},
    "cylinder of a file": _rod,
}


def touches(p: Any, name: str) -> list[list[list[float]]]:
    """Where a hull touches a cylinder that lies against one of its sides, in many poses."""
    hull = p.createMultiBody(1, _hull(name)(p))
    cylinder = p.createMultiBody(1, p.createCollisionShape(p.GEOM_CYLINDER, radius=0.1, height=0.5))
    low, high = p.getAABB(hull)
    found = []
    for number in range(_POSES):
        quarter, turn = number % 4, number // 4 * pi / 12
        away = 0.0985 + (high[0] if quarter % 2 == 0 else -low[0])
        place = [away if quarter % 2 == 0 else -away, 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])]
        axis = p.getQuaternionFromEuler([turn, 0.0, 0.0])
        # Away first, so that no contact is kept.
        for position in ([10.0, 0.0, 0.0], place):
            p.resetBasePositionAndOrientation(cylinder, position, axis)
            p.performCollisionDetection()
        contacts = p.getContactPoints(hull, cylinder)
        found.append([[*it[5], *it[6], *it[7], it[8]] for it in contacts])
    return found
