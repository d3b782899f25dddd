"""MuJoCo's law, solved until it converges: the accelerations of its own steps."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.converged.yielding_scenes import SCENES, STEPS

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


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(SCENES[name])
    world = World(contact="compliant")
    world.load(path).apply_options()
    assert _RECORDED[name]
    for step in _RECORDED[name]:
        *before, after, expected = map(np.array, step)
        found = _velocities_after(world, before, after)
        # What is compared are accelerations over a step of 2 ms, relative to the greatest.
        greatest = max(1.0, np.abs(expected - before[1]).max() / 0.002)
        assert np.abs(found - expected).max() / 0.002 / greatest < 1e-6
