"""Soft bodies that touch each other: nodes of either on faces of the other, with friction."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, momentum, rigid, world

from carom import World
from carom.description import Plane
from carom.scene.soft_body import SoftBody


def contacts(where: World, first: SoftBody, second: SoftBody) -> list[tuple]:
    found, columns = where.queries().contact_columns(first.id, -2, second.id, -2, where.parameters.time_step)
    return list(zip(*columns, strict=False))[:found]


def stack(where: World, friction: float = 0.7) -> tuple[SoftBody, SoftBody]:
    """Two cubes of 40 cm, one above the other on a plane."""
    rigid(where, Plane(), friction=1.0)
    size, cells = (0.4, 0.4, 0.4), (3, 3, 3)
    options: dict[str, Any] = {"youngs_modulus": 5e4, "damping": 0.1, "friction": friction, "margin": 0.01}
    lower = where.load_soft_solid(size, cells, (0, 0, 0.211), mass=4.0, **options)
    upper = where.load_soft_solid(size, (2, 2, 2), (0.01, 0.02, 0.63), mass=2.0, **options)
    return lower, upper


def test_a_collision_keeps_momentum() -> None:
    where = world(0.0)
    solid = where.load_soft_solid(0.2, 4, (0, 0, 0), mass=2.0, youngs_modulus=2e4)
    cloth = where.load_cloth(
        (0.5, 0.5), (10, 10), (0.4, 0.05, 0), (0, np.sqrt(0.5), 0, np.sqrt(0.5)), mass=0.5
    )
    solid.set_base_velocity((4.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    where.step(60)
    assert momentum(cloth)[0] > 0.5
    assert momentum(solid) + momentum(cloth) == pytest.approx([8.0, 0.0, 0.0], abs=1e-9)


def test_a_cube_rests_on_a_cube_at_the_margin() -> None:
    where = world()
    lower, upper = stack(where)
    where.step(720)
    found = contacts(where, upper, lower)
    assert found
    assert {row[:4] for row in found} == {(upper.id, lower.id, -1, -1)}
    # Either bears what is above it.
    assert sum(row[6][2] * row[8] for row in found) == pytest.approx(2.0 * GRAVITY, rel=0.01)
    gaps = np.array([row[7] for row in found])
    assert np.abs(gaps).max() < 0.001
    # By their middles: the weight that each bears squeezes it, its own by half.
    middle = np.linalg.norm(lower.soft_spec.nodes[:, :2], axis=1) < 0.1
    assert np.ptp(lower.nodes[middle, 2]) == pytest.approx(0.4 * (1 - 4.0 * GRAVITY / 0.16 / 5e4), abs=0.002)
    assert np.abs(upper.node_velocities).max() < 0.01
    turned = contacts(where, lower, upper)
    assert len(turned) == len(found)
    assert {row[:4] for row in turned} == {(lower.id, upper.id, -1, -1)}
    assert sum(row[6][2] * row[8] for row in turned) == pytest.approx(-2.0 * GRAVITY, rel=0.01)


@pytest.mark.parametrize("friction", [0.0, 0.4, 1.0])
def test_it_slides_by_the_product_of_both_coefficients(friction: float) -> None:
    """A small cube on a cloth that is stretched out and held at all its nodes, under gravity askew."""
    where = world()
    cloth = where.load_cloth((2.0, 0.8), (20, 8), friction=friction, margin=0.01)
    for node in range(len(cloth.nodes)):
        cloth.anchor(node)
    cube = where.load_soft_solid(
        (0.1, 0.1, 0.1), (1, 1, 1), (-0.5, 0, 0.06), mass=0.5, youngs_modulus=1e5, damping=0.05,
        friction=0.5, margin=0.01,
    )  # fmt: skip
    where.step(120)
    start = cube.nodes[:, 0].mean()
    where.gravity = (3.0, 0.0, -GRAVITY)
    where.step(120)
    way = max(0.0, 3.0 - 0.5 * friction * GRAVITY) * 0.5**2 / 2
    assert cube.nodes[:, 0].mean() - start == pytest.approx(way, abs=0.02)


@pytest.mark.parametrize("cells", [4, 25])
@pytest.mark.parametrize("radius", [0.05, 0.2])
@pytest.mark.parametrize("speed", [2.0, 40.0])
def test_nothing_goes_through_cloth(speed: float, radius: float, cells: int) -> None:
    """A ball thrown at cloth that is held at its edges, whose cells are larger and smaller than the ball."""
    where = world(0.0)
    cloth = where.load_cloth((1.0, 1.0), (cells, cells), stiffness=500.0, mass=0.5, margin=0.01)
    for node in np.flatnonzero(np.abs(cloth.nodes[:, :2]).max(axis=1) > 0.499):
        cloth.anchor(int(node))
    ball = where.load_soft_solid(radius, 4, (0.03, 0.02, 0.5), youngs_modulus=2e4, mass=0.2, margin=0.01)
    ball.set_base_velocity((0.0, 0.0, -speed), (0.0, 0.0, 0.0))
    where.step(round(240 * 1.5 / min(speed, 4.0)))
    assert ball.nodes[:, 2].min() > cloth.nodes[:, 2].max()
    assert ball.node_velocities[:, 2].mean() > 0.0


@pytest.mark.long
def test_cloth_drapes_over_a_soft_ball() -> None:
    where = world()
    rigid(where, Plane())
    ball = where.load_soft_solid(
        0.2, 6, (0, 0, 0.21), youngs_modulus=2e4, mass=2.0, damping=0.05, friction=0.5, margin=0.01
    )
    cloth = where.load_cloth(
        (0.8, 0.8), (16, 16), (0, 0, 0.5), mass=0.2, damping=0.2, friction=0.5, margin=0.01
    )
    where.step(720)
    # The cloth lies a margin above the ball, and none of its nodes is inside.
    over = np.linalg.norm(cloth.nodes[:, :2] - ball.nodes[:, :2].mean(axis=0), axis=1) < 0.05
    top = ball.nodes[:, 2].max()
    assert cloth.nodes[over, 2] == pytest.approx(top + 0.01, abs=0.006)
    assert np.linalg.norm(cloth.nodes - ball.nodes.mean(axis=0), axis=1).min() > 0.15
    found = contacts(where, cloth, ball)
    assert sum(row[6][2] * row[8] for row in found) > 0.0
