"""The order of overlaps of bodies that are reset before a step, against PyBullet's.

`getContactPoints` of PyBullet lists manifolds in their order, so the orders written here are from there.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

import pybullet as p
from carom import World
from carom.layouts.contacts import MANY_RESETS, MAX_RESETS, RESETS, RESETS_SEEN
from pybullet._bodies.bodies import resetBasePositionAndOrientation, resetBaseVelocity
from pybullet._clients.clients import client_of
from pybullet._joints.joints import resetJointState

from .test_overlaps import manifolds_of

UNTURNED = (0.0, 0.0, 0.0, 1.0)

# Through the native library, and in Python.
SETTERS = {
    "native": (p.resetBasePositionAndOrientation, p.resetBaseVelocity, p.resetJointState),
    "python": (resetBasePositionAndOrientation, resetBaseVelocity, resetJointState),
}


@pytest.fixture(autouse=True)
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def cubes(height: float) -> list[int]:
    """A box as floor, body and shape 0, and four cubes beside each other, this far above it."""
    p.setGravity(0, 0, -9.81)
    ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 0.5])
    p.createMultiBody(0, ground, basePosition=[0, 0, -0.5])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    return [p.createMultiBody(1, shape, basePosition=[0.5 * i, 0, 0.1 + height]) for i in range(4)]


def on_floor() -> list[int]:
    """The shapes that overlap the floor, in order of manifolds."""
    return [b for a, b in manifolds_of(client_of(0).world) if a == 0]


def place_and_step(rested: int, setters: str) -> list[tuple[float, ...]]:
    """Poses and velocities of a cube that rested for so many steps, in five steps elsewhere."""
    (cube, *_) = cubes(0.0)
    p.stepSimulation()
    for _ in range(rested):
        p.stepSimulation()
    SETTERS[setters][0](cube, [-0.7, 0.3, 0.1], UNTURNED)
    found = []
    for _ in range(5):
        p.stepSimulation()
        place, velocities = p.getBasePositionAndOrientation(cube), p.getBaseVelocity(cube)
        found.append((*place[0], *place[1], *velocities[0], *velocities[1]))
    p.resetSimulation()
    return found


@pytest.mark.parametrize("setters", SETTERS)
def test_what_held_and_is_put_elsewhere_moves_as_if_it_had_never_been_there(setters: str):
    (cube, *_) = cubes(0.0)
    SETTERS[setters][0](cube, [-0.7, 0.3, 0.1], UNTURNED)
    p.stepSimulation()
    fresh = (*p.getBasePositionAndOrientation(cube)[0], *p.getBaseVelocity(cube)[1])
    p.resetSimulation()
    first = place_and_step(30, setters)
    assert (*first[0][:3], *first[0][10:]) == fresh
    assert place_and_step(47, setters) == first


@pytest.mark.parametrize("setters", SETTERS)
def test_points_of_where_it_was_keep_out_new_ones_of_what_did_not_hold_yet(setters: str):
    # One point of four is left, and the cube tilts, as in PyBullet, which finds these velocities.
    found = place_and_step(0, setters)[0][7:]
    assert_allclose(found, (-0.00195966, 0.00195966, -0.02978948, -0.13688793, -0.13688793, 0.0), atol=1e-8)


@pytest.mark.parametrize("setters", SETTERS)
def test_bodies_that_get_a_velocity_are_compared_first(setters: str):
    bodies = cubes(0.005)
    for i in (2, 0, 3, 2):
        SETTERS[setters][1](bodies[i], [0.0, 0.0, 0.0])
    p.stepSimulation()
    assert on_floor() == [3, 1, 4, 2]


def test_bodies_that_touch_when_they_are_created_have_been_compared():
    bodies = cubes(-1e-4)
    for i in (2, 0, 3):
        p.resetBaseVelocity(bodies[i], [0.0, 0.0, 0.0])
    p.stepSimulation()
    assert on_floor() == [1, 2, 3, 4]


@pytest.mark.parametrize("setters", SETTERS)
@pytest.mark.parametrize("is_stepped", [False, True])
@pytest.mark.parametrize("height", [0.005, -1e-4])
def test_bodies_that_are_moved_are_compared_where_they_are_put(height: float, is_stepped: bool, setters: str):
    bodies = cubes(2.0)
    place, push, _ = SETTERS[setters]
    if is_stepped:
        p.stepSimulation()
    # What moves a body counts, not what comes before or after it.
    push(bodies[3], [0.0, 0.0, 0.0])
    for i in (2, 0, 3, 1):
        place(bodies[i], [0.5 * i, 0.0, 0.1 + height], UNTURNED)
    place(bodies[2], [1.0, 0.0, 0.1 + height], UNTURNED)
    push(bodies[0], [0.0, 0.0, 0.0])
    p.stepSimulation()
    assert on_floor() == [3, 1, 4, 2]


@pytest.mark.parametrize("setters", SETTERS)
def test_bodies_whose_joints_are_set_are_compared_first(setters: str):
    p.setGravity(0, 0, -9.81)
    ground = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 0.5])
    p.createMultiBody(0, ground, basePosition=[0, 0, -0.5])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    sliders = [
        p.createMultiBody(
            0, basePosition=[0.5 * i, 0, 1], linkMasses=[1], linkCollisionShapeIndices=[shape],
            linkVisualShapeIndices=[-1], linkPositions=[[0, 1, 0]], linkOrientations=[UNTURNED],
            linkInertialFramePositions=[[0, 0, 0]], linkInertialFrameOrientations=[UNTURNED],
            linkParentIndices=[0], linkJointTypes=[p.JOINT_PRISMATIC], linkJointAxis=[[0, 0, 1]],
        )
        for i in range(3)
    ]  # fmt: skip
    p.stepSimulation()
    for i in (1, 2, 0):
        SETTERS[setters][2](sliders[i], 0, -0.895)
    p.stepSimulation()
    assert on_floor() == [2, 3, 1]


def test_resets_are_in_saved_states_and_files(tmp_path: Path):
    bodies = cubes(0.005)
    for i in (2, 0, 3):
        p.resetBaseVelocity(bodies[i], [0.0, 0.0, 0.0])
    state = p.saveState()
    world = client_of(0).world
    world.save(tmp_path / "world.carom")
    for _ in range(2):
        p.stepSimulation()
        p.restoreState(state)
    p.stepSimulation()
    assert on_floor() == [3, 1, 4, 2]
    copy = World()
    copy.load(tmp_path / "world.carom")
    copy.step()
    assert [b for _, b in manifolds_of(copy)] == [3, 1, 4, 2]


def test_resets_are_counted_from_0_after_many():
    bodies = cubes(2.0)
    world = client_of(0).world
    counts = world.contact_arrays.contacts.numpy["count_contacts"][0]
    counts[[RESETS, RESETS_SEEN]] = MANY_RESETS
    for i in (2, 0, 3, 1):
        p.resetBasePositionAndOrientation(bodies[i], [0.5 * i, 0.0, 0.105], UNTURNED)
    p.stepSimulation()
    assert on_floor() == [3, 1, 4, 2]
    assert counts[RESETS] == counts[RESETS_SEEN] == 0
    # Otherwise all these bodies would count as reset whenever one is.
    assert not world.arrays.state.numpy["tree_reset"].any()
    counts[RESETS] = MAX_RESETS
    for setter in (p.resetBaseVelocity, resetBaseVelocity):
        setter(bodies[0], [0.0, 0.0, 0.0])
        assert counts[RESETS] == MAX_RESETS
    p.stepSimulation()
    assert counts[RESETS] == 0
