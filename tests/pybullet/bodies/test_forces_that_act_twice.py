"""External forces on bodies with maximal coordinates: in the deformable world they act twice.

The figures are those of PyBullet 3.2.7.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data

PUSH = 1.0 / 0.1 / 240.0


@pytest.fixture(autouse=True)
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield
    p.disconnect()


def created(maximal: bool) -> int:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.01)
    return p.createMultiBody(0.1, shape, basePosition=[0, 0, 5], useMaximalCoordinates=maximal)


def loaded(maximal: bool) -> int:
    return p.loadURDF("cube_small.urdf", [0, 0, 5], useMaximalCoordinates=maximal)


def in_a_file(tmp_path: Path) -> Path:
    path = tmp_path / "ball.xml"
    path.write_text(
        '<mujoco><worldbody><body pos="0 0 1"><geom type="sphere" size="0.05"/></body></worldbody></mujoco>'
    )
    return path


def speed_after_a_push(body: int) -> float:
    p.applyExternalForce(body, -1, [1, 0, 0], [0, 0, 0], p.LINK_FRAME)
    p.stepSimulation()
    return p.getBaseVelocity(body)[0][0]


@pytest.mark.parametrize("make", [created, loaded])
@pytest.mark.parametrize(
    ("flag", "maximal", "times"),
    [
        (p.RESET_USE_DEFORMABLE_WORLD, True, 2),
        (p.RESET_USE_REDUCED_DEFORMABLE_WORLD, True, 2),
        (p.RESET_USE_DEFORMABLE_WORLD, False, 1),
        (0, True, 1),
    ],
)
def test_forces_act_twice_on_maximal_coordinates_in_the_deformable_world(
    make: Callable[[bool], int], flag: int, maximal: bool, times: int
) -> None:
    p.resetSimulation(flag)
    body = make(maximal)
    # The first step is PyBullet's to 0.01 %: reduced coordinates are damped.
    assert speed_after_a_push(body) == pytest.approx(times * PUSH, rel=2e-4)
    assert speed_after_a_push(body) == pytest.approx(2 * times * PUSH, rel=6e-4)


def test_torques_act_twice_and_gravity_does_not() -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -1)
    body = created(True)
    p.applyExternalTorque(body, -1, [0, 0, 1e-5], p.WORLD_FRAME)
    p.stepSimulation()
    velocity, spin = p.getBaseVelocity(body)
    assert spin[2] == pytest.approx(0.0208333333, rel=2e-4)
    assert velocity[2] == pytest.approx(-1 / 240, rel=2e-4)


def test_substeps_do_not_count() -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setPhysicsEngineParameter(numSubSteps=2)
    assert speed_after_a_push(created(True)) == pytest.approx(0.0833333333, rel=2e-4)


def test_a_number_that_is_given_again_starts_anew() -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    first = created(True)
    p.removeBody(first)
    second = created(False)
    assert second == first
    assert speed_after_a_push(second) == pytest.approx(PUSH, rel=2e-4)
    p.resetSimulation()
    assert speed_after_a_push(created(True)) == pytest.approx(PUSH, rel=2e-4)


@pytest.mark.parametrize(("multi_body", "speed"), [(1, 0.0079577471), (0, 0.0159154943)])
def test_bodies_of_mjcf_files_have_them_too(tmp_path: Path, multi_body: int, speed: float) -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    (ball,) = p.loadMJCF(str(in_a_file(tmp_path)), useMultiBody=multi_body)
    assert speed_after_a_push(ball) == pytest.approx(speed, rel=2e-4)
