"""Hulls of up to 512 corners that roll, tumble and walk, for PyBullet and for Carom."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, pi, sin, sqrt
from random import Random
from typing import Any

Size = tuple[float, float, float]
Points = list[list[float]]
STEPS = 180


def _ball(count: int, radius: float, size: Size = (1, 1, 1), rough: float = 0) -> Points:
    """Corners spread evenly over a ball or an ellipsoid, whose radius may vary by a share of it."""
    random, turn = Random(count), pi * (3 - sqrt(5))
    points = []
    for place in range(count):
        z = 1 - 2 * (place + 0.5) / count
        flat = sqrt(1 - z * z)
        out = radius * (1 + rough * random.uniform(-1, 1))
        direction = (flat * cos(turn * place), flat * sin(turn * place), z)
        points.append([out * along * scale for along, scale in zip(direction, size, strict=True)])
    return points


def _rings(rings: int, sides: int, radius: float) -> Points:
    """Corners of a globe of meridians, as modellers make it."""
    points = [[0.0, 0.0, radius], [0.0, 0.0, -radius]]
    for ring in range(1, rings):
        height, out = radius * cos(pi * ring / rings), radius * sin(pi * ring / rings)
        angles = [2 * pi * side / sides for side in range(sides)]
        points += [[out * cos(angle), out * sin(angle), height] for angle in angles]
    return points


HULLS: dict[str, Callable[[], Points]] = {
    "12 corners": lambda: _ball(12, 0.1),
    "42 corners": lambda: _ball(42, 0.1),
    "100 corners": lambda: _ball(100, 0.1),
    "250 corners": lambda: _ball(250, 0.1),
    "512 corners": lambda: _ball(512, 0.1),
    "a globe": lambda: _rings(16, 30, 0.1),
    "a rough ball": lambda: _ball(400, 0.1, rough=0.003),
    "an egg": lambda: _ball(300, 0.1, (1, 0.7, 0.5)),
}
GROUNDS = ("plane", "box", "hull")


def roll(p: Any, hull: str, ground: str) -> list[list[float]]:
    """Throws a hull on the ground: number of contacts, position and orientation after each third step."""
    _begin(p, ground)
    points = HULLS[hull]()
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=points)
    body = p.createMultiBody(1, shape, -1, [0, 0, max(point[2] for point in points) + 0.02])
    p.changeDynamics(body, -1, localInertiaDiagonal=[0.004, 0.004, 0.004])
    p.resetBaseVelocity(body, [0.5, 0.2, 0], [1, 2, 0.5])
    return _follow(p, body, lambda step: None)


def walk(p: Any) -> list[list[float]]:
    """Lets four legs with finely rounded feet trot on a box."""
    _begin(p, "box")
    foot = p.createCollisionShape(p.GEOM_MESH, vertices=_ball(320, 0.03))
    bone = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.01, 0.01, 0.05])
    trunk = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.15, 0.08, 0.03])
    hips = [[x, y, 0] for x in (-0.12, 0.12) for y in (-0.1, 0.1)]
    still, along = [0, 0, 0, 1], [0, 0, -0.06]
    legs = range(4)
    body = p.createMultiBody(
        2.0,
        trunk,
        -1,
        [0, 0, 0.16],
        linkMasses=[0.2, 0.1] * 4,
        linkCollisionShapeIndices=[bone, foot] * 4,
        linkVisualShapeIndices=[-1, -1] * 4,
        linkPositions=[place for hip in hips for place in (hip, [0, 0, -0.11])],
        linkOrientations=[still] * 8,
        linkInertialFramePositions=[along, [0, 0, 0]] * 4,
        linkInertialFrameOrientations=[still] * 8,
        linkParentIndices=[parent for leg in legs for parent in (0, 2 * leg + 1)],
        linkJointTypes=[p.JOINT_REVOLUTE, p.JOINT_PRISMATIC] * 4,
        linkJointAxis=[[0, 1, 0], [0, 0, 1]] * 4,
    )

    def swing(step: int) -> None:
        for leg in legs:
            phase = 0.08 * step + (pi if leg in (1, 2) else 0)
            hip, lift = 0.3 * sin(phase), 0.02 * max(cos(phase + 0.3), 0)
            p.setJointMotorControl2(body, 2 * leg, p.POSITION_CONTROL, hip, force=4, positionGain=0.3)
            p.setJointMotorControl2(body, 2 * leg + 1, p.POSITION_CONTROL, lift, force=60, positionGain=0.3)

    return _follow(p, body, swing)


def _begin(p: Any, ground: str) -> None:
    p.setGravity(0, 0, -10)
    half = [5, 5, 0.5]
    corners = [[x, y, z] for x in (-5, 5) for y in (-5, 5) for z in (-0.5, 0.5)]
    shape = {
        "plane": lambda: p.createCollisionShape(p.GEOM_PLANE),
        "box": lambda: p.createCollisionShape(p.GEOM_BOX, halfExtents=half),
        "hull": lambda: p.createCollisionShape(p.GEOM_MESH, vertices=corners),
    }[ground]()
    p.createMultiBody(0, shape, -1, [0, 0, 0 if ground == "plane" else -0.5])


def _follow(p: Any, body: int, control: Callable[[int], None]) -> list[list[float]]:
    found = []
    for step in range(STEPS):
        control(step)
        p.stepSimulation()
        if step % 3 == 2:
            position, orientation = p.getBasePositionAndOrientation(body)
            found.append([len(p.getContactPoints(body)), *position, *orientation])
    return found
