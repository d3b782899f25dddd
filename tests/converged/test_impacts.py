"""Restitution by the rigid law: heights, cradles and stacks of balls at their closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from tests.converged.rigid_worlds import GRAVITY, rigid_world, speed

from carom import World


@pytest.mark.parametrize("restitution", [1.0, 0.9, 0.5])
def test_a_ball_returns_to_the_height_of_the_closed_form(restitution: float) -> None:
    world = rigid_world()
    world.add_plane(restitution=1.0)
    ball = world.add_sphere(0.1, (0.0, 0.0, 1.1), restitution=restitution)
    tops = []
    before = speed(ball)[2]
    height = 1.0
    while len(tops) < 3:
        last = height
        world.step()
        height, now = ball.pose.position[2] - 0.1, speed(ball)[2]
        if before > 0.0 >= now:
            tops.append(max(last, height))
        before = now
    assert tops == pytest.approx([restitution ** (2 * k) for k in (1, 2, 3)], abs=5e-5)


@pytest.mark.parametrize("movers", [1, 2])
@pytest.mark.parametrize("gap", [0.0, 1e-3])
def test_a_cradle_passes_its_impact_on(movers: int, gap: float) -> None:
    world = World(contact="rigid")
    balls = [
        world.add_sphere(0.1, ((0.2 + gap) * i - (0.05 if i < movers else 0.0), 0.0, 0.0), restitution=1.0)
        for i in range(5)
    ]
    for ball in balls[:movers]:
        ball.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(60)
    speeds = [speed(ball)[0] for ball in balls]
    assert speeds == pytest.approx([0.0] * (5 - movers) + [1.0] * movers, abs=1e-6)


def test_momentum_and_energy_of_unequal_balls_are_kept() -> None:
    world = World(contact="rigid")
    first = world.add_sphere(0.1, (0.0, 0.0, 0.0), mass=1.0, restitution=1.0)
    second = world.add_sphere(0.1, (0.25, 0.0, 0.0), mass=3.0, restitution=1.0)
    first.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    world.step(60)
    assert [speed(first)[0], speed(second)[0]] == pytest.approx([-0.5, 0.5], abs=1e-8)


def test_a_light_ball_on_a_heavy_one_is_thrown_up() -> None:
    world = rigid_world()
    world.add_plane(restitution=1.0)
    world.add_sphere(0.1, (0.0, 0.0, 1.1), mass=1.0, restitution=1.0)
    light = world.add_sphere(0.1, (0.0, 0.0, 1.3001), mass=0.01, restitution=1.0)
    fastest = 0.0
    for _ in range(240):
        world.step()
        fastest = max(fastest, speed(light)[2])
    assert fastest / np.sqrt(2.0 * GRAVITY) == pytest.approx((3.0 - 0.01) / 1.01, rel=0.03)


def test_without_restitution_nothing_rebounds() -> None:
    world = rigid_world()
    world.add_plane()
    ball = world.add_sphere(0.1, (0.0, 0.0, 1.1))
    fastest = 0.0
    for _ in range(480):
        world.step()
        fastest = max(fastest, speed(ball)[2])
    # The depth of rest is reached from below.
    assert fastest < 1e-3
    assert ball.pose.position[2] == pytest.approx(0.1, abs=1e-5)
