"""Velocities that scripts set for fixed bases: they turn with the base, up to the greatest velocity."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pybullet as p
import pybullet_data

Velocity = tuple[list[float], list[float]]


@pytest.fixture(autouse=True)
def _client() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield
    p.disconnect()


def box(mass: float) -> int:
    return p.createMultiBody(mass, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3))


BASES = {
    "of mass 0": lambda: box(0.0),
    "fixed": lambda: p.loadURDF("cube_small.urdf", useFixedBase=1),
    "of an arm": lambda: p.loadURDF("kuka_iiwa/model.urdf", [0.1, 0.0, -0.07], useFixedBase=1),
}

# Linear and angular velocity, their bound if not the usual one, substeps; and after three steps of PyBullet
# the linear velocity, the angular one about z, and the position.
MEASURED: list[tuple[list[float], float, float | None, int, list[float], float, list[float]]] = [
    ([1, 0, 0], 3, None, 1, [0.9995312, 0.037498, 0], 3, [0.0124974, 0.0003125, 0]),
    ([200, 150, 0], 120, None, 1, [16.6666667, 100, 0], 100, [0.7291667, 1.25, 0]),
    ([10, 0, 0], 7, 5, 1, [4.9856771, 0.4998734, 0], 5, [0.062415, 0.0049474, 0]),
    ([1, 0, 0], 3, None, 3, [0.999375, 0.0374939, 0], 3, [0.0124971, 0.0002604, 0]),
    ([200, 150, 0], 120, None, 3, [-11.1111111, 100, 0], 100, [0.5555556, 1.25, 0]),
    ([10, 0, 0], 7, 5, 3, [4.9878499, 0.374775, 0], 5, [0.0624381, 0.0029505, 0]),
]


@pytest.mark.parametrize("base", BASES)
@pytest.mark.parametrize("measured", MEASURED)
def test_velocities_turn_with_the_base(base: str, measured: tuple) -> None:
    linear, turning, bound, substeps, then_linear, then_turning, then_position = measured
    body = BASES[base]()
    p.setPhysicsEngineParameter(numSubSteps=substeps)
    if bound is not None:
        p.changeDynamics(body, -1, maxJointVelocity=bound)
    p.resetBaseVelocity(body, linear, [0, 0, turning])
    for _ in range(3):
        p.stepSimulation()
    velocity, spin = p.getBaseVelocity(body)
    assert velocity == pytest.approx(then_linear, abs=1e-7)
    assert spin == pytest.approx([0, 0, then_turning], abs=1e-7)
    assert p.getBasePositionAndOrientation(body)[0] == pytest.approx(then_position, abs=1e-7)


def test_a_box_rides_on_a_plate_that_turns_and_moves() -> None:
    plate = p.createMultiBody(0.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[1, 1, 0.1]))
    rider = p.createMultiBody(
        1.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3), -1, [0.4, 0, 0.2]
    )
    p.setGravity(0, 0, -10)
    p.resetBaseVelocity(plate, [0.3, 0, 0], [0, 0, 1])
    for _ in range(240):
        p.stepSimulation()
    # In PyBullet.
    assert p.getBasePositionAndOrientation(plate)[0] == pytest.approx([0.2524, 0.1386, 0.0], abs=1e-4)
    assert p.getBasePositionAndOrientation(rider)[0] == pytest.approx([0.4856, 0.4283, 0.2], abs=1e-4)
    assert p.getBaseVelocity(rider)[0] == pytest.approx([-0.1263, 0.4873, 0.0], abs=1e-4)


def test_a_step_that_is_repeated_turns_a_velocity_once() -> None:
    """The arrays of contacts are too short for what lands here: steps begin again with longer ones."""
    velocities = []
    for riders in (0, 60):
        p.resetSimulation()
        p.setGravity(0, 0, -10)
        plate = p.createMultiBody(0.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[4, 4, 0.1]))
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
        for number in range(riders):
            p.createMultiBody(1.0, shape, -1, [number % 8 * 0.3 - 1, number // 8 * 0.3 - 1, 0.201])
        p.resetBaseVelocity(plate, [0.3, 0, 0], [0, 0, 1])
        for _ in range(20):
            p.stepSimulation()
        velocities.append(p.getBaseVelocity(plate))
    assert velocities[0] == velocities[1]
