"""MuJoCo's law, solved until it converges: the accelerations of its own steps."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.converged.yielding_scenes import SCENES, STEPS, WITHOUT_SLIP

from carom import World

_RECORDED = json.loads(STEPS.read_text())


def turn_of(quaternion: np.ndarray) -> np.ndarray:
    """The rotation matrix of a quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def _velocities_after(world: World, before: list[np.ndarray], after: np.ndarray) -> np.ndarray:
    """Velocities, in MuJoCo's coordinates, after a step from positions and velocities `before`."""
    positions, velocities = before
    free = [body for body in world if body.name in ("a", "b", "c") and not body.joints.movable]
    if not free:
        joints = next(body for body in world if body.joints.movable).joints
        joints.positions, joints.velocities = positions, velocities
        world.step()
        return joints.velocities
    for number, body in enumerate(free):
        place, rate = positions[7 * number :][:7], velocities[6 * number :][:6]
        body.pose = (place[:3], place[[4, 5, 6, 3]])
        body.set_base_velocity(rate[:3].tolist(), (turn_of(place[3:]) @ rate[3:]).tolist())
    world.step()
    found = []
    for number, body in enumerate(free):
        velocity = body.links[-1].velocity
        found += [velocity.linear, turn_of(after[7 * number + 3 :][:4]).T @ velocity.angular]
    return np.concatenate(found)


def _error(name: str, text: str, folder: Path) -> float:
    return error_of_steps(_RECORDED[name], text, folder)


def error_of_steps(steps: list, text: str, folder: Path) -> float:
    """The greatest error of an acceleration in the recorded steps of a scene, relative to the greatest."""
    path = folder / "scene.xml"
    path.write_text(text)
    world = World(contact="compliant")
    world.load(path).apply_options()
    assert steps
    worst = 0.0
    for step in steps:
        *before, after, expected = map(np.array, step)
        found = _velocities_after(world, before, after)
        # What is compared are accelerations over a step of 2 ms, relative to the greatest.
        greatest = max(1.0, np.abs(expected - before[1]).max() / 0.002)
        worst = max(worst, float(np.abs(found - expected).max() / 0.002 / greatest))
    return worst


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    assert _error(name, SCENES[name], tmp_path) < 1e-6


@pytest.mark.parametrize("name", WITHOUT_SLIP)
def test_passes_without_slip_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    if name.startswith(("limb, elliptic, condim 3", "limb, elliptic, condim 4")):
        # MuJoCo leaves cones of these in a plane as they were: one of their directions moves nothing.
        assert 1e-3 < _error(name, WITHOUT_SLIP[name], tmp_path) < 0.05
        return
    # Both go over contacts one after the other, in another order, until little changes.
    assert _error(name, WITHOUT_SLIP[name], tmp_path) < 3e-4
    if name.startswith("box"):
        assert _error(name, WITHOUT_SLIP[name].replace("1000", "0"), tmp_path) > 1e-3


def test_passes_without_slip_are_refused_where_nothing_follows_from_them_and_are_copied(
    tmp_path: Path,
) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(WITHOUT_SLIP["limb, pyramidal, condim 3, no slip"])
    world = World()
    world.load(path)
    assert world.parameters.noslip_iterations == 1000
    world.step(40)
    with pytest.raises(NotImplementedError, match="noslip_iterations"):
        world.inverse_dynamics(0 * world.velocity)
    copy = world.copy()
    world.save(tmp_path / "world.carom")
    loaded = World()
    loaded.load(tmp_path / "world.carom")
    for each in (world, copy, loaded):
        each.step(20)
    assert copy.position.tolist() == loaded.position.tolist() == world.position.tolist()
