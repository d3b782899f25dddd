"""What steps say about islands: numbers as PyBullet 3.2.7 gave them for the same calls."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pybullet as p
import pybullet_data

Islands = list[tuple[int, int]]


@pytest.fixture
def world() -> Iterator[None]:
    client = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -10)
    p.setPhysicsEngineParameter(reportSolverAnalytics=1)
    yield
    p.disconnect(client)


def islands() -> Islands:
    return [(int(entry["islandId"]), int(entry["numBodies"])) for entry in p.stepSimulation()]


def test_where_nothing_is_solved_there_is_one_entry_of_no_island(world: None) -> None:
    assert islands() == []
    p.loadURDF("cube_small.urdf", [0, 0, 5], useFixedBase=True)
    assert islands() == []
    p.createMultiBody(1)
    nothing = {"islandId": -1, "numBodies": 1, "numIterationsUsed": 1, "remainingResidual": 0.0}
    assert p.stepSimulation() == (nothing,)
    p.createMultiBody(1)
    assert islands() == [(-1, 2)]


def test_islands_have_the_number_of_their_last_link(world: None) -> None:
    falling = p.loadURDF("cube_small.urdf", [0, 0, 5])
    p.loadURDF("plane.urdf")
    assert islands() == [(-1, 1)]
    p.loadURDF("cube_small.urdf", [1, 0, 0.024])
    # The falling cube goes with the next island.
    assert islands() == [(1, 2)]
    p.loadURDF("cube_small.urdf", [2, 0, 0.024])
    assert islands() == [(1, 2), (2, 1)]
    arm = p.loadURDF("kuka_iiwa/model.urdf", [0, 3, 0], useFixedBase=True)
    assert islands() == [(1, 2), (2, 1), (9, 7)]
    for joint in range(p.getNumJoints(arm)):
        p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
    # There are still rows of joints, which do nothing.
    assert islands() == [(1, 2), (2, 1), (9, 7)]
    p.loadURDF("r2d2.urdf", [0, -3, 0.5])
    assert islands() == [(1, 2), (2, 1), (9, 7), (25, 16)]
    p.createConstraint(falling, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [0, 0, 5])
    assert islands() == [(0, 1), (1, 1), (2, 1), (9, 7), (25, 16)]


def test_small_islands_go_together(world: None) -> None:
    p.setPhysicsEngineParameter(minimumSolverIslandSize=1)
    p.loadURDF("plane.urdf")
    for place in range(4):
        p.loadURDF("cube_small.urdf", [place, 0, 0.024])
    assert islands() == [(1, 2), (3, 2)]
