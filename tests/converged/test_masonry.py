"""Arches and houses of cards stand by the rigid law, and fall where they have to."""

from __future__ import annotations

from math import atan
from pathlib import Path

import numpy as np
import pytest
from tests.converged.masonry import HEIGHT, THICKNESS, arch, house, pair
from tests.converged.rigid_worlds import centres, rigid_world

from carom import World
from carom.scene.body import Body

SECONDS = [8, pytest.param(600, marks=pytest.mark.long)]


def drift(world: World, bodies: list[Body], seconds: int) -> float:
    """How far the farthest body moves after the first second [m]."""
    world.step(240)
    start = centres(bodies)
    world.step(240 * (seconds - 1))
    return np.linalg.norm(centres(bodies) - start, axis=1).max()


@pytest.mark.parametrize("seconds", SECONDS)
def test_an_arch_of_fifteen_voussoirs_stands(tmp_path: Path, seconds: int) -> None:
    world = rigid_world()
    stones = arch(world, tmp_path)
    start = centres(stones)
    assert drift(world, stones, seconds) < 1e-9
    # Joints yield by micrometres, and no more.
    assert np.abs(centres(stones) - start).max() < 5e-5


def test_an_arch_falls_whose_joints_have_too_little_friction(tmp_path: Path) -> None:
    world = rigid_world()
    stones = arch(world, tmp_path, friction=0.2)
    world.step(480)
    assert stones[7].pose.position[2] < 0.8


@pytest.mark.parametrize("seconds", SECONDS)
@pytest.mark.parametrize("storeys", [2, 4])
def test_a_house_of_cards_stands(storeys: int, seconds: int) -> None:
    world = rigid_world()
    cards = house(world, storeys)
    start = centres(cards)
    assert drift(world, cards, seconds) < 1e-9
    assert np.abs(centres(cards) - start).max() < 5e-5


@pytest.mark.parametrize(("share", "stands"), [(0.999, True), (1.01, False)])
@pytest.mark.parametrize("friction", [0.2, 0.4])
def test_a_card_leans_on_a_smooth_wall_up_to_its_angle(friction: float, share: float, stands: bool) -> None:
    world = rigid_world()
    world.add_plane(friction=friction**0.5)
    world.add_box((0.5, 0.5, 0.5), (-0.5, 0.0, 0.5), mass=0.0, friction=0.0)
    # The weight acts in the middle, beside the edge that stands; the wall bears no part of it.
    angle = atan(share * (2.0 * friction + THICKNESS / HEIGHT))
    card, left = pair(world, angle, friction)
    world.remove(left)
    height = card.pose.position[2]
    world.step(960)
    fell = height - card.pose.position[2]
    assert fell < 1e-5 if stands else fell > 0.3 * HEIGHT
