"""Soft bodies in worlds of each law of contacts."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World, Worlds

_LAWS = ("bullet", "rigid", "compliant")


def _scene(law: str) -> World:
    """A towel over a box on a floor, and a second box on the towel."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law)
    world.add_plane()
    world.add_box((0.2, 0.2, 0.05), (0.0, 0.0, 0.05), mass=1.0, name="lower")
    world.load_cloth((0.8, 0.8), (12, 12), (0.0, 0.0, 0.15), mass=0.2)
    world.add_box((0.1, 0.1, 0.05), (0.0, 0.0, 0.25), mass=0.3, name="upper")
    return world


@pytest.mark.parametrize("law", _LAWS)
def test_a_box_rests_on_a_towel_on_a_box(law: str) -> None:
    world = _scene(law)
    world.step(480)
    # The towel has a margin of 1 cm, and gives way a little.
    assert world["upper"].pose.position[2] == pytest.approx(0.15, abs=2e-3)
    assert world["lower"].pose.position[2] == pytest.approx(0.05, abs=1e-4)
    assert np.abs(world["upper"].pose.position[:2]).max() < 0.02
    assert np.abs(world.velocity).max() < 0.1


@pytest.mark.parametrize("law", _LAWS)
def test_what_cloth_weighs_is_borne_by_the_floor(law: str) -> None:
    world = _scene(law)
    world.remove("upper")
    world.step(480)
    force = abs(world.force_between("lower", "plane")[2])
    # A part of the towel lies on the floor itself.
    assert 1.0 * 9.81 + 0.2 < force < 1.2 * 9.81 + 0.05


def test_many_worlds_with_cloth_move_like_one() -> None:
    world = _scene("compliant")
    worlds = Worlds(world, 3)
    world.step(60)
    worlds.step(60)
    for name in ("lower", "upper"):
        assert worlds[name].pose.position[2].tolist() == world[name].pose.position.tolist()


def test_a_snapshot_of_a_world_with_cloth_repeats() -> None:
    world = _scene("compliant")
    world.step(60)
    state = world.snapshot()
    world.step(30)
    first = world.position.copy()
    world.restore(state)
    world.step(30)
    assert world.position.tolist() == first.tolist()


def test_midpoint_is_discrete_where_there_are_soft_bodies() -> None:
    heights = []
    for integrator in ("midpoint", "discrete"):
        world = _scene("compliant")
        world.integrator = integrator
        world.step(60)
        heights.append(world.position.tolist())
    assert heights[0] == heights[1]


@pytest.mark.parametrize("integrator", ["euler", "explicit", "implicitfast", "implicit"])
def test_other_integrators_move_cloth_too(integrator: str) -> None:
    world = _scene("compliant")
    world.integrator = integrator
    world.step(480)
    assert world["upper"].pose.position[2] == pytest.approx(0.15, abs=2e-3)


def test_runge_kutta_is_refused_beside_cloth() -> None:
    with pytest.raises(NotImplementedError, match="cannot have soft bodies"):
        _scene("compliant").integrator = "rk4"


def test_inverse_dynamics_needs_a_world_without_soft_bodies() -> None:
    world = _scene("compliant")
    with pytest.raises(NotImplementedError, match="without soft bodies"):
        world.inverse_dynamics(np.zeros(len(world.velocity)))
