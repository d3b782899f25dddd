"""Breaking distances: of manifolds, of bounds and of balls' old points, against answers of PyBullet."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.testing import assert_allclose

import pybullet as p
from carom.layouts.contacts import AS_LINKS, AS_SHAPES
from carom.world_files.saved_state import add_breaking_distances

HALF_BLOCK = 10.0


@pytest.fixture(autouse=True)
def connection() -> Iterator[int]:
    """A connection, with gravity."""
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    yield client
    p.disconnect(client)


def ground(shape: int) -> None:
    """Something to stand on, up to a height of 0."""
    if shape == p.GEOM_BOX:
        box = p.createCollisionShape(shape, halfExtents=(1, 1, 0.5))
        p.createMultiBody(0, box, basePosition=(0, 0, -0.5))
    elif shape == p.GEOM_PLANE:
        p.createMultiBody(0, p.createCollisionShape(shape))
    else:
        p.createMultiBody(0, p.createCollisionShape(shape, radius=1), basePosition=(0, 0, -1))


def puck_on_a_box(speed: float, height: float) -> int:
    """A puck that lands, or leaves, while it turns."""
    ground(p.GEOM_BOX)
    shape = p.createCollisionShape(p.GEOM_CYLINDER, radius=0.5, height=0.4)
    puck = p.createMultiBody(1, shape, basePosition=(0, 0, 0.2 + height))
    p.resetBaseVelocity(puck, (0.3, 0, speed), (0.2, 0.5, 0))
    return puck


def numbers_of_points(steps: int) -> list[int]:
    """How many contact points there are after each of some steps."""
    numbers = []
    for _ in range(steps):
        p.stepSimulation()
        numbers.append(len(p.getContactPoints()))
    return numbers


@pytest.mark.parametrize(
    ("threshold", "gap", "touches"),
    [
        (0.02, 0.039, True),
        (0.02, 0.041, False),
        (0.002, 0.003, True),
        (0.002, 0.005, False),
        (0.05, 0.09, True),
        (0.05, 0.11, False),
    ],
)
def test_bounds_are_widened_by_the_threshold(threshold: float, gap: float, touches: bool):
    """Contacts of large shapes, whose breaking distances are greater, begin where their bounds meet."""
    p.setGravity(0, 0, 0)
    p.setPhysicsEngineParameter(contactBreakingThreshold=threshold)
    p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[HALF_BLOCK] * 3))
    block = p.createCollisionShape(p.GEOM_CYLINDER, radius=HALF_BLOCK, height=2 * HALF_BLOCK)
    p.createMultiBody(1, block, basePosition=(0, 0, 2 * HALF_BLOCK + gap))
    assert numbers_of_points(1) == ([1] if touches else [0])


@pytest.mark.parametrize(
    ("before", "after", "speed", "height", "numbers", "end"),
    [
        (0.02, 0.001, -0.3, 0.0005, [1, 2, 3, 4, 4, 4, 4, 4, 4, 4, 4, 4], 0.19978741861090618),
        (0.02, 0.001, 0.2, 0.0, [1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3], 0.20068562211422825),
        (0.001, 0.02, 0.2, 0.0, [1] * 12, 0.2006855944056689),
    ],
)
def test_manifolds_keep_the_breaking_distance_they_were_made_with(
    before: float, after: float, speed: float, height: float, numbers: list[int], end: float
):
    p.setPhysicsEngineParameter(contactBreakingThreshold=before)
    puck = puck_on_a_box(speed, height)
    found = numbers_of_points(2)
    p.setPhysicsEngineParameter(contactBreakingThreshold=after)
    found += numbers_of_points(10)
    assert found == numbers
    # Which point of parallel faces is found depends on rounding.
    assert_allclose(p.getBasePositionAndOrientation(puck)[0][2], end, atol=1e-6)


def test_new_manifolds_have_the_new_breaking_distance():
    p.setPhysicsEngineParameter(contactBreakingThreshold=0.001)
    puck = puck_on_a_box(-0.3, 0.0005)
    assert numbers_of_points(6) == [1, 2, 1, 1, 1, 1]
    p.setPhysicsEngineParameter(contactBreakingThreshold=0.02)
    p.resetBasePositionAndOrientation(puck, (0, 0, 2), (0, 0, 0, 1))
    p.stepSimulation()
    p.resetBasePositionAndOrientation(puck, (0, 0, 0.2005), (0, 0, 0, 1))
    p.resetBaseVelocity(puck, (0.3, 0, -0.3), (0.2, 0.5, 0))
    assert numbers_of_points(6) == [1, 2, 3, 4, 4, 4]


def test_states_keep_breaking_distances():
    p.setPhysicsEngineParameter(contactBreakingThreshold=0.02)
    puck = puck_on_a_box(-0.3, 0.0005)
    assert numbers_of_points(2) == [1, 2]
    p.setPhysicsEngineParameter(contactBreakingThreshold=0.001)
    state = p.saveState()
    assert numbers_of_points(4) == [3, 4, 4, 4]
    height = p.getBasePositionAndOrientation(puck)[0][2]
    p.restoreState(state)
    assert numbers_of_points(4) == [3, 4, 4, 4]
    assert p.getBasePositionAndOrientation(puck)[0][2] == height


def test_manifolds_of_older_files_have_the_breaking_distance_of_their_shapes():
    contacts = {"overlap_shapes": np.zeros((2, 2), dtype=np.int32)}
    add_breaking_distances(contacts)
    assert contacts["overlap_breaking"].tolist() == [AS_SHAPES, AS_SHAPES]
    assert contacts["overlap_solved_up_to"].tolist() == [AS_LINKS, AS_LINKS]


@pytest.mark.parametrize(
    ("shape", "threshold", "numbers"),
    [
        (p.GEOM_BOX, 0.001, [1, 2, 3, 4, 4, 4, 4, 4, 4, 4]),
        (p.GEOM_BOX, 0.004, [1] * 10),
        (p.GEOM_PLANE, 0.001, [1, 2, 3, 4, 4, 4, 4, 4, 4, 4]),
        (p.GEOM_PLANE, 0.004, [1] * 10),
        (p.GEOM_SPHERE, 0.001, [1] * 10),
    ],
)
def test_balls_that_roll_farther_than_the_breaking_distance_keep_old_points(
    shape: int, threshold: float, numbers: list[int]
):
    p.setPhysicsEngineParameter(contactBreakingThreshold=threshold)
    ground(shape)
    round_one = p.createCollisionShape(p.GEOM_SPHERE, radius=0.25)
    ball = p.createMultiBody(1, round_one, basePosition=(0.01, 0, 0.2495))
    p.resetBaseVelocity(ball, (0.3, 0, -0.1), (0.2, 0.5, 0))
    assert numbers_of_points(10) == numbers
