"""Two boxes that touch, and stacks of turned boxes, for PyBullet and for Carom."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import product
from math import cos, pi, sin, sqrt
from random import Random
from typing import Any

Numbers = list[float]
Box = tuple[Numbers, Numbers, Numbers]
"""Half extents, position, orientation."""

UPRIGHT = [0.0, 0.0, 0.0, 1.0]
YAWS = (pi / 4, pi / 2, pi, pi / 6, 0.05, -0.05, 1e-3, 1e-6)
OFFSETS = ((0.1, 0.0), (0.0, 0.1), (0.1, 0.1), (-0.1, 0.05), (0.03, 0.0), (0.0, -0.07), (-0.05, -0.05))
STACKS = (0, 3, 5, 9)
"""Seeds of stacks that a shift by 1e-13 m does not make move another way in PyBullet, as it does others."""
STEPS = 480
DROPS = (1e-3, 5e-3)
"""Heights from which cubes fall [m]."""


def _about(axis: Numbers, angle: float) -> Numbers:
    length = sqrt(sum(along * along for along in axis))
    return [*(along / length * sin(angle / 2) for along in axis), cos(angle / 2)]


def _product(first: Numbers, second: Numbers) -> Numbers:
    """The turn `second`, then the turn `first`."""
    a, b, c, d = first
    x, y, z, w = second
    return [
        d * x + a * w + b * z - c * y,
        d * y - a * z + b * w + c * x,
        d * z + a * y - b * x + c * w,
        d * w - a * x - b * y - c * z,
    ]


def _direction(random: Random, numbers: int) -> Numbers:
    vector = [random.gauss(0, 1) for _ in range(numbers)]
    length = sqrt(sum(along * along for along in vector))
    return [along / length for along in vector]


def _aligned_pairs() -> dict[str, tuple[Box, Box]]:
    """Boxes whose faces lie on each other: in line, shifted, turned, smaller and larger."""
    pairs: dict[str, tuple[Box, Box]] = {}
    cube = [0.1, 0.1, 0.1]
    for half, depth, axis, sign in product((0.1, 0.25, 0.5), (0.0, 1e-4, 1e-3), range(3), (1, -1)):
        place = [0.0, 0.0, 0.0]
        place[axis] = sign * (2 * half - depth)
        size = [half, half, half]
        pairs[f"in line, {half} {depth} {axis} {sign}"] = (size, [0.0] * 3, UPRIGHT), (size, place, UPRIGHT)
    for sideways, below in product(OFFSETS, (1, -1)):
        upper = (cube, [*sideways, 0.1999 * below], UPRIGHT)
        pairs[f"shifted, {sideways} {below}"] = (cube, [0.0] * 3, UPRIGHT), upper
    sizes = {"equal": (cube, cube), "on large": ([1, 1, 0.1], cube), "on small": (cube, [1, 1, 0.1])}
    for (name, (lower, upper)), yaw, shift in product(sizes.items(), YAWS, (0.0, 0.03)):
        turned = (upper, [shift, shift / 2, 0.1999], _about([0, 0, 1], yaw))
        pairs[f"turned, {name} {yaw:.6f} {shift}"] = (lower, [0.0] * 3, UPRIGHT), turned
    return pairs


def _tilted_pairs() -> dict[str, tuple[Box, Box]]:
    """Boxes of any size that overlap a little: turned at random, or nearly along each other's axes."""
    random, pairs = Random(4), {}
    for number in range(120):
        first = _direction(random, 4)
        second = _direction(random, 4)
        if number % 3:
            axis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]][random.randrange(3)]
            turn = pi / 2 * random.randrange(4) if number % 3 == 2 else random.uniform(-3, 3)
            slightly = _about(_direction(random, 3), 10 ** random.uniform(-5, -1))
            second = _product(first, _product(slightly, _about(axis, turn)))
        halves = [[random.uniform(0.05, 0.3) for _ in range(3)] for _ in range(2)]
        way = _direction(random, 3)
        reach = random.uniform(0.5, 0.95) * (min(halves[0]) + min(halves[1]))
        boxes = (halves[0], [0.0] * 3, first), (halves[1], [along * reach for along in way], second)
        pairs[f"tilted, {number}"] = boxes
    return pairs


def pairs() -> dict[str, tuple[Box, Box]]:
    """All pairs of boxes by name."""
    return {**_aligned_pairs(), **_tilted_pairs()}


def points(p: Any, boxes: tuple[Box, Box]) -> list[Numbers]:
    """Contacts of two boxes, in order: point on the first, normal, distance."""
    p.resetSimulation()
    for half, position, orientation in boxes:
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=half)
        p.createMultiBody(1, shape, -1, position, orientation)
    p.performCollisionDetection()
    return [[*contact[5], *contact[7], contact[8]] for contact in p.getContactPoints()]


def _build_stack(p: Any, seed: int) -> list[int]:
    """Four boxes on a block, each turned at random and pressed slightly into the one below."""
    random = Random(seed)
    p.resetSimulation()
    p.setGravity(0, 0, -10)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5]), -1, [0, 0, -0.5])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.12, 0.08])
    bodies = []
    for height in range(4):
        place = [random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.0799 + 0.1599 * height]
        bodies.append(p.createMultiBody(1, shape, -1, place, _about([0, 0, 1], random.uniform(-0.6, 0.6))))
    return bodies


def _build_cubes(p: Any, drop: float) -> list[int]:
    """27 cubes with gaps of 5 mm, each `drop` above what is below it, over a large box."""
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 0.5])
    p.createMultiBody(0, ground, basePosition=[0, 0, -0.5])
    cube = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    return [
        p.createMultiBody(1, cube, basePosition=[0.205 * x, 0.205 * y, 0.1 + drop + (0.2 + drop) * z])
        for x, y, z in product(range(3), repeat=3)
    ]


def scenes() -> dict[str, Callable[[Any], list[int]]]:
    """Scenes whose motion is recorded, by name: functions that build them and return the bodies."""
    stacks = {f"stack {seed}": partial(_build_stack, seed=seed) for seed in STACKS}
    return {**stacks, **{f"cubes {drop}": partial(_build_cubes, drop=drop) for drop in DROPS}}


def follow(p: Any, bodies: list[int]) -> list[Numbers]:
    """Positions and orientations of bodies after each 40th step."""
    found = []
    for step in range(STEPS):
        p.stepSimulation()
        if step % 40 == 39:
            poses = [p.getBasePositionAndOrientation(body) for body in bodies]
            found.append([number for pose in poses for part in pose for number in part])
    return found
