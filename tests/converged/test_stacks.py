"""What stands by the rigid law stands for ever."""

from __future__ import annotations

import numpy as np
import pytest
from tests.converged.rigid_worlds import centres, rigid_world, tower


@pytest.mark.parametrize(
    ("count", "seconds"),
    [
        (10, 10),
        pytest.param(10, 600, marks=pytest.mark.long),
        pytest.param(20, 600, marks=pytest.mark.long),
    ],
)
def test_a_tower_with_boxes_off_centre_does_not_drift(count: int, seconds: int) -> None:
    world = rigid_world()
    boxes = tower(world, count)
    world.step(240)
    start = centres(boxes)
    world.step(240 * (seconds - 1))
    assert np.linalg.norm(centres(boxes) - start, axis=1).max() < 1e-4
    assert np.abs(world.velocity).max() < 1e-6


def test_the_same_tower_drifts_with_sweeps() -> None:
    world = rigid_world()
    world.contact = "bullet"
    boxes = tower(world, 10)
    world.step(240)
    start = centres(boxes)
    world.step(240 * 4)
    assert np.linalg.norm(centres(boxes) - start, axis=1).max() > 1e-3


def test_a_hundred_kilograms_on_one_hardly_sink() -> None:
    world = rigid_world()
    lower, upper = tower(world, 2, 0.0, [1.0, 100.0])
    world.step(480)
    assert abs(lower.pose.position[2] - 0.1) < 1e-4
    assert abs(upper.pose.position[2] - 0.3) < 1e-4


def test_a_dropped_tower_settles_and_then_stays() -> None:
    world = rigid_world()
    boxes = tower(world, 5)
    for i, box in enumerate(boxes):
        x, y, z = box.pose.position
        box.pose = (x, y, z + 0.01 * (i + 1)), box.pose.orientation
    world.step(720)
    start = centres(boxes)
    assert start[-1, 2] == pytest.approx(0.9, abs=1e-3)
    world.step(480)
    assert np.linalg.norm(centres(boxes) - start, axis=1).max() < 1e-5


def test_a_contact_with_a_spring_sinks_by_its_load() -> None:
    world = rigid_world()
    (box,) = tower(world, 1, 0.0)
    box.change_dynamics(-1, contact_stiffness=1e4, contact_damping=100.0)
    world.step(480)
    # Each of the four corners has the spring.
    assert 0.1 - box.pose.position[2] == pytest.approx(9.81 / 4e4, rel=0.05)
