"""Coulomb's friction by the rigid law: no creep below its angle; no lift, and no heading counts, above it."""

from __future__ import annotations

import numpy as np
import pytest
from tests.converged.rigid_worlds import GRAVITY, STEP, rigid_world

from carom import World
from carom.scene.body import Body

_FRICTION = 0.5


def _box_on_slope(share: float, heading: float) -> tuple[World, Body]:
    """A box on a slope with so much of the tangent of the angle of friction, after it was put down."""
    world = rigid_world(np.arctan(share * _FRICTION), heading)
    world.add_plane(friction=1.0)
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=_FRICTION)
    return world, box


@pytest.mark.parametrize("seconds", [2, pytest.param(20, marks=pytest.mark.long)])
@pytest.mark.parametrize("heading", [0.0, 0.6, np.pi / 4])
def test_a_box_below_the_angle_of_friction_stays(heading: float, seconds: int) -> None:
    world, box = _box_on_slope(0.999, heading)
    world.step(240 * seconds)
    assert np.linalg.norm(box.pose.position - np.array([0.0, 0.0, 0.1])) < 1e-5


@pytest.mark.parametrize("heading", [0.0, 0.6, np.pi / 4])
def test_a_box_above_it_slides_as_coulomb_says(heading: float) -> None:
    world, box = _box_on_slope(1.001, heading)
    world.step(480)
    slope = np.arctan(1.001 * _FRICTION)
    acceleration = GRAVITY * (np.sin(slope) - _FRICTION * np.cos(slope))
    moved = np.array(box.pose.position)
    along = moved[:2] @ [np.cos(heading), np.sin(heading)]
    # Velocities come first, then positions: half a step more than the parabola.
    assert along == pytest.approx(0.5 * acceleration * 2.0 * (2.0 + STEP), rel=0.01)
    assert abs(moved[:2] @ [-np.sin(heading), np.cos(heading)]) < 1e-7


@pytest.mark.parametrize("heading", [0.0, 0.6, np.pi / 4])
def test_the_distance_of_sliding_is_that_of_the_integrator(heading: float) -> None:
    world = rigid_world()
    world.add_plane(friction=1.0)
    box = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 0.1), friction=0.3)
    world.step(3)
    start = np.array(box.pose.position)
    along = np.array([np.cos(heading), np.sin(heading), 0.0])
    box.set_base_velocity((3.0 * along).tolist(), (0.0, 0.0, 0.0))
    highest = 0.0
    for _ in range(480):
        world.step()
        highest = max(highest, box.pose.position[2] - start[2])
    distance = 3.0**2 / (2.0 * 0.3 * GRAVITY) - 3.0 * STEP / 2.0
    moved = box.pose.position - start
    assert moved @ along == pytest.approx(distance, abs=5e-5)
    assert np.abs(moved - moved @ along * along).max() < 1e-5
    # No lift: MuJoCo's cone jumps 7 mm.
    assert highest < 1e-5


def test_a_ball_that_slides_rolls_off_at_five_sevenths() -> None:
    world = rigid_world()
    world.add_plane(friction=1.0)
    ball = world.add_sphere(0.1, (0.0, 0.0, 0.1), friction=0.4)
    ball.set_base_velocity((2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(240)
    velocity = np.array(ball.links[-1].velocity.linear)
    assert velocity[0] == pytest.approx(2.0 * 5.0 / 7.0, rel=2e-3)


@pytest.mark.parametrize("heading", [0.0, 0.6, np.pi / 4])
@pytest.mark.parametrize(("kind", "share"), [("sphere", 5.0 / 7.0), ("cylinder", 2.0 / 3.0)])
def test_what_rolls_down_a_slope_gains_its_share_of_gravity(kind: str, share: float, heading: float) -> None:
    slope = 0.3
    world = rigid_world(slope, heading)
    world.add_plane(friction=1.0)
    if kind == "sphere":
        body = world.add_sphere(0.1, (0.0, 0.0, 0.1), friction=0.8)
    else:
        half = np.sqrt(0.5)
        across = (-half * np.cos(heading), -half * np.sin(heading), 0.0, half)
        body = world.add_cylinder(0.1, 0.2, (0.0, 0.0, 0.1), across, friction=0.8)
    world.step(480)
    moved = np.array(body.pose.position)
    along = moved[:2] @ [np.cos(heading), np.sin(heading)]
    assert along == pytest.approx(0.5 * share * GRAVITY * np.sin(slope) * 2.0 * (2.0 + STEP), rel=1e-5)
    assert abs(moved[:2] @ [-np.sin(heading), np.cos(heading)]) < 1e-9
