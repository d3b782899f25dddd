"""Worlds of many bodies that touch, for engines with PyBullet's interface."""

from __future__ import annotations

import pybullet as p

EDGE = 0.2
MOST_OFF = 5e-3
"""How far a box may have moved while its tower came to rest [m]."""
RADIUS = 0.05


def _floor() -> None:
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))


def settle(steps: int) -> None:
    """Let everything come to rest, or nearly."""
    for _ in range(steps):
        p.stepSimulation()


def towers(side: int) -> None:
    """`side` by `side` towers of `side` boxes on the floor."""
    _floor()
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[EDGE / 2] * 3)
    places = []
    for i in range(side):
        for j in range(side):
            for k in range(side):
                place = [1.05 * EDGE * i, 1.05 * EDGE * j, EDGE * (k + 0.5)]
                p.createMultiBody(1, shape, basePosition=place)
                places.append(place)
    settle(60)
    for body, place in enumerate(places, start=1):
        found, _ = p.getBasePositionAndOrientation(body)
        off = max(abs(a - b) for a, b in zip(found, place))  # noqa: B905 (old Pythons run this)
        assert off < MOST_OFF, f"box {body} is {off:.3g} m from its place: the towers have fallen"


def pile(count: int) -> None:
    """Balls that were dropped in layers of ten by ten and roll off each other."""
    _floor()
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS)
    for n in range(count):
        layer, row, column = n // 100, n // 10 % 10, n % 10
        place = [2.02 * RADIUS * column, 2.02 * RADIUS * row, RADIUS * (1.2 + 2.2 * layer)]
        place[0] += 0.06 * RADIUS * (layer % 3)
        place[1] += 0.04 * RADIUS * (layer % 2)
        p.createMultiBody(1, shape, basePosition=place)
    settle(150)


def scattered(count: int) -> None:
    """Balls and boxes side by side on the floor, none touching another."""
    _floor()
    shapes = [
        p.createCollisionShape(p.GEOM_SPHERE, radius=RADIUS),
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[RADIUS] * 3),
    ]
    side = int(count**0.5) + 1
    for n in range(count):
        place = [6 * RADIUS * (n % side), 6 * RADIUS * (n // side), 1.2 * RADIUS]
        p.createMultiBody(1, shapes[n % 2], basePosition=place)
    settle(20)


def fans_of_rays(count: int) -> tuple[list[list[float]], list[list[float]]]:
    """Starts and ends of rays from above a pile of balls, some of which miss."""
    side = int(count**0.5)
    starts = [[0.0, 0.0, 3.0]] * (side * side)
    ends = [[2.0 * i / side - 0.5, 2.0 * j / side - 0.5, -0.5] for i in range(side) for j in range(side)]
    return starts, ends
