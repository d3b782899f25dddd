"""Anchors: what bodies feel of the cloth that is anchored to them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.soft.scenes import rigid, world

from carom import World
from carom.description import Sphere
from carom.scene.body import Body
from carom.scene.soft_body import SoftBody


def held(damping: float, damped: bool, late_force: float = 0.0) -> tuple[World, SoftBody, Body]:
    """A ball in motion with a corner of cloth anchored to it, without gravity."""
    where = world()
    where.gravity = (0.0, 0.0, 0.0)
    cloth = where.load_cloth((1.0, 1.0), (4, 4), (0.0, 0.0, 1.0), damping=damping)
    x, y, z = cloth.nodes[0].tolist()
    ball = rigid(where, Sphere(0.005), 0.1, (x, y, z))
    cloth.anchor(0, ball, damped=damped, late_force=late_force)
    ball.set_base_velocity((1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    return where, cloth, ball


def speed(damping: float, damped: bool) -> float:
    where, _cloth, ball = held(damping, damped)
    where.step()
    return float(where.velocity[ball.first_velocity + 3])


def test_damping_acts_on_the_body_if_asked_to() -> None:
    assert speed(5.0, damped=False) == pytest.approx(speed(0.0, damped=False), rel=1e-3)
    assert speed(5.0, damped=True) < 0.95 * speed(0.0, damped=True)


def test_nodes_end_a_step_where_their_bodies_are() -> None:
    where, cloth, ball = held(0.1, damped=True)
    for _ in range(5):
        where.step()
        place = where.position[ball.first_position :][:3]
        assert np.allclose(cloth.nodes[0], place, rtol=0.0, atol=1e-12)


def test_files_keep_how_bodies_are_coupled(tmp_path: Path) -> None:
    where, _cloth, _ball = held(0.1, damped=False, late_force=0.5)
    where.save(tmp_path / "held.carom")
    again = World()
    again.load(tmp_path / "held.carom")
    (anchor,) = again.contact_arrays.soft.anchors.values()
    assert (anchor.damped, anchor.late_force) == (False, 0.5)


@pytest.mark.parametrize("share", [-0.1, 1.1, float("nan")])
def test_shares_of_forces_are_between_0_and_1(share: float) -> None:
    where = world()
    cloth = where.load_cloth((1.0, 1.0), (4, 4))
    with pytest.raises(ValueError, match="late_force"):
        cloth.anchor(0, late_force=share)
