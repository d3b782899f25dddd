"""Motion with each integrator beside MuJoCo's own, recorded."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.converged.test_yielding import turn_of
from tests.integrators.record import RECORDED
from tests.integrators.scenes import INTEGRATORS, SCENES, STEPS, file_of

from carom import World

_MOTION = json.loads(RECORDED.read_text())["motion"]
# With "discrete" MuJoCo lets a lone free body turn implicitly, Carom does not; Carom bounds the force of a
# servo at the end of a step, and moves bases by their centres of mass. So it does with RK4, which is the same
# to fourth order; but what yields is stiff.
_DIFFERENT = (
    *("free body, discrete", "servos, discrete", "servos at bounds, discrete"),
    *(f"{scene}, discrete" for scene in SCENES if scene.endswith("off its frame")),
    *(f"{word} off its frame, RK4" for word in ("tied", "welded", "falling", "hung")),
)
_NAMES = [
    name
    for scene in SCENES
    for integrator in INTEGRATORS
    if (name := f"{scene}, {integrator}") not in _DIFFERENT
]


def _numbers(world: World) -> np.ndarray:
    """Positions and velocities in MuJoCo's coordinates, without positions of balls, of the last body.

    MuJoCo's velocities are those of the origin of the frame, Carom's those of the centre of mass.
    """
    body = [*world][-1]
    joints = body.joints
    movable = bool(joints.movable)
    positions = list(joints.positions) if movable else []
    velocities = list(joints.velocities) if movable else []
    if body.fixed_base:
        return np.array([*positions[-1:], *velocities])
    place, turn = body.pose
    x, y, z, w = turn
    first = body.first_velocity
    angular, linear = world.velocity[first : first + 3], world.velocity[first + 3 : first + 6]
    rotation = turn_of(np.array([w, x, y, z]))
    own = rotation.T @ angular
    linear = linear - np.cross(angular, rotation @ body.spec.base.inertial_frame.position)
    return np.array([*place, w, x, y, z, *positions, *linear, *own, *velocities])


def _expected(recorded: dict[str, list[float]], found: np.ndarray) -> np.ndarray:
    velocities = recorded["qvel"]
    expected = np.array([*recorded["qpos"][-(len(found) - len(velocities)) :], *velocities])
    if len(recorded["qpos"]) > len(velocities) and expected[3:7] @ found[3:7] < 0.0:
        # The other quaternion of the same turn.
        expected[3:7] *= -1.0
    return expected


def loaded(name: str, folder: Path, contact: str) -> World:
    """A world at the start of a scene, whose file names the integrator."""
    scene, integrator = name.rsplit(", ", 1)
    path = folder / "scene.xml"
    path.write_text(file_of(scene, integrator))
    world = World(contact=contact)
    content = world.load(path)
    assert not content.ignored.that_matter
    assert world.integrator == integrator.lower()
    content.reset(next(iter(content.keyframes)))
    return world


@pytest.mark.parametrize("name", _NAMES)
def test_motion_is_that_of_mujoco(name: str, tmp_path: Path) -> None:
    world = loaded(name, tmp_path, "compliant")
    for recorded in _MOTION[name]:
        world.step(STEPS // 2)
        found = _numbers(world)
        assert np.abs(found - _expected(recorded, found)).max() < 1e-6
