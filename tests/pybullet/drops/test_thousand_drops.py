"""A thousand random drops of every pair of shapes: nothing becomes NaN, falls through or is flung away."""

import math
import random
from itertools import combinations_with_replacement, product

import numpy as np
import pytest
from tests.pybullet.drops.test_drops import BODIES, SITE, turned

import pybullet as p

DROPS = 1000
SIDE = 32
"""Sites on a side of the square they are in, one for each drop."""
WIDTH = SITE * (SIDE + 4)
"""Of the grounds, so that nothing gets to their edges [m]."""
SECONDS = 0.6
HIGHEST = 0.75
"""Height from which things fall at most [m]."""
FASTEST = math.sqrt(2 * 9.81 * HIGHEST) + 1.0
DEEPEST = 0.02
"""Penetration in the midst of a heap that nobody calls a tunnel [m]."""


def wave(x: float, y: float) -> float:
    """Height of the uneven grounds [m]: slopes of up to 0.1."""
    return 0.05 * math.sin(x) * math.cos(y)


def plane() -> int:
    return p.createCollisionShape(p.GEOM_PLANE)


def mesh() -> int:
    """A surface of 4,608 triangles."""
    count = 49
    places = [WIDTH * (i / (count - 1) - 0.5) for i in range(count)]
    corners = [[x, y, wave(x, y)] for y, x in product(places, repeat=2)]
    cells = [row * count + column for row, column in product(range(count - 1), repeat=2)]
    indices = [
        corner
        for cell in cells
        for corner in (cell, cell + 1, cell + count, cell + 1, cell + count + 1, cell + count)
    ]
    return p.createCollisionShape(
        p.GEOM_MESH, vertices=corners, indices=indices, flags=p.GEOM_FORCE_CONCAVE_TRIMESH
    )


def heightfield() -> int:
    """A grid of points 1 m apart; its middle height is at the origin of the body."""
    count = round(WIDTH) + 1
    places = [i - (count - 1) / 2 for i in range(count)]
    return p.createCollisionShape(
        p.GEOM_HEIGHTFIELD,
        heightfieldData=[wave(x, y) for y, x in product(places, repeat=2)],
        numHeightfieldRows=count,
        numHeightfieldColumns=count,
    )


GROUNDS = {"plane": plane, "mesh": mesh, "heightfield": heightfield}
SHAPES = list(BODIES)
PAIRS = list(combinations_with_replacement(range(len(SHAPES)), 2))


def ground_of(pair: tuple[int, int]) -> str:
    """Grounds take turns, so that each shape falls on each of them in a thousand drops or more."""
    return list(GROUNDS)[sum(pair) % len(GROUNDS)]


def test_every_shape_falls_on_every_ground() -> None:
    seen = {(shape, ground_of(pair)) for pair in PAIRS for shape in pair}
    assert seen == set(product(range(len(SHAPES)), GROUNDS))


def motions(bodies: list[int]) -> np.ndarray:
    """Position and velocity of each body, shape (n, 6)."""
    return np.array(
        [p.getBasePositionAndOrientation(body)[0] + p.getBaseVelocity(body)[0] for body in bodies]
    )


@pytest.mark.long
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: f"{SHAPES[pair[0]]} and {SHAPES[pair[1]]}")
def test_drops(client: int, pair: tuple[int, int]) -> None:
    """At each site one falls on the ground and the other on it, both turned and thrown at random."""
    chance = random.Random(str(pair))
    p.setGravity(0, 0, -9.81)
    ground = p.createMultiBody(0, GROUNDS[ground_of(pair)]())
    shapes = [BODIES[SHAPES[shape]]() for shape in pair]
    bodies: list[int] = []
    for site in range(DROPS):
        x, y = SITE * (site % SIDE - SIDE / 2 + 0.5), SITE * (site // SIDE - SIDE / 2 + 0.5)
        for shape, height in zip(shapes, (0.25, HIGHEST - 0.15), strict=True):
            place = [x + chance.uniform(-0.04, 0.04), y + chance.uniform(-0.04, 0.04), height]
            body = p.createMultiBody(1, shape, basePosition=place, baseOrientation=turned(chance))
            spin = [chance.uniform(-5, 5) for _ in range(3)]
            p.resetBaseVelocity(body, [chance.uniform(-0.2, 0.2), chance.uniform(-0.2, 0.2), 0], spin)
            bodies.append(body)
    met = set[int]()
    for step in range(round(SECONDS * 240)):
        p.stepSimulation()
        if step % 8 == 0:
            moving = motions(bodies)
            assert np.isfinite(moving).all()
            assert np.linalg.norm(moving[:, 3:], axis=1).max() < FASTEST
            met |= {contact[1] for contact in p.getContactPoints() if ground not in contact[1:3]}
    places = motions(bodies)[:, :3]
    floor = 0.0 if ground_of(pair) == "plane" else -0.05
    assert places[:, 2].min() > floor + 0.03
    assert places[:, 2].max() < HIGHEST
    assert np.abs(places[:, :2]).max() < SITE * SIDE / 2 + 1.0
    assert min(contact[8] for contact in p.getContactPoints()) > -DEEPEST
    assert len(met) > 0.7 * DROPS
