"""What soft bodies do to links besides pushing them: sleepers wake up, sensors feel them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from tests.soft.scenes import GRAVITY, write_cube

import pybullet as p
import pybullet_data


@pytest.fixture(autouse=True)
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -GRAVITY)
    yield
    p.disconnect()


def solid(tmp_path: object, position: list[float], mass: float) -> int:
    return p.loadSoftBody(
        str(write_cube(tmp_path / "cube.vtk", 2)), position, mass=mass, useNeoHookean=1, NeoHookeanMu=4000,  # type: ignore[operator]
        NeoHookeanLambda=4000, NeoHookeanDamping=0.05, collisionMargin=0.01, frictionCoeff=1.0,
    )  # fmt: skip


def sleeping_box() -> int:
    p.loadURDF("plane.urdf")
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    box = p.createMultiBody(0.5, shape, basePosition=[0, 0, 0.1])
    p.changeDynamics(box, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
    for _ in range(720):
        p.stepSimulation()
    p.applyExternalForce(box, -1, [2, 0, 0], [0, 0, 0], p.LINK_FRAME)
    p.stepSimulation()
    # Forces wake nobody up: it is asleep.
    assert p.getBaseVelocity(box)[0] == (0.0, 0.0, 0.0)
    return box


def place_after_hit(tmp_path: object, box: int) -> tuple[float, float, float]:
    cube = solid(tmp_path, [-0.6, 0, 0.25], 2.0)
    p.resetBaseVelocity(cube, [3, 0, 0])
    for _ in range(120):
        p.stepSimulation()
    return p.getBasePositionAndOrientation(box)[0]


def test_a_soft_body_wakes_what_it_hits(tmp_path: object) -> None:
    assert place_after_hit(tmp_path, sleeping_box())[0] > 0.1


def test_a_soft_body_does_not_wake_what_may_not_wake_up(tmp_path: object) -> None:
    box = sleeping_box()
    place = p.getBasePositionAndOrientation(box)[0]
    p.changeDynamics(box, -1, activationState=p.ACTIVATION_STATE_DISABLE_WAKEUP)
    assert place_after_hit(tmp_path, box) == place


def test_a_soft_body_wakes_what_holds_it(tmp_path: object) -> None:
    box = sleeping_box()
    cube = solid(tmp_path, [0, 0, 0.45], 5.0)
    nodes = np.array(p.getMeshData(cube, flags=p.MESH_DATA_SIMULATION_MESH)[1])
    for node in np.flatnonzero(nodes[:, 2] < 0.26):
        p.createSoftBodyAnchor(cube, int(node), box, -1)
    p.resetBaseVelocity(cube, [3, 0, 0])
    for _ in range(60):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(box)[0][0] > 0.05


def test_what_a_soft_body_at_rest_lies_on_falls_asleep(tmp_path: object) -> None:
    p.loadURDF("plane.urdf")
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.3, 0.3, 0.1])
    box = p.createMultiBody(5.0, shape, basePosition=[0, 0, 0.1])
    p.changeDynamics(box, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING)
    solid(tmp_path, [0, 0, 0.42], 0.5)
    for _ in range(1440):
        p.stepSimulation()
    assert p.getBaseVelocity(box)[0] == (0.0, 0.0, 0.0)


@pytest.mark.parametrize("anchored", [False, True])
def test_sensors_feel_its_weight(tmp_path: object, anchored: bool) -> None:
    plate = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.4, 0.4, 0.05])
    stand = p.createMultiBody(
        0, basePosition=[0, 0, 1], linkMasses=[1.0], linkCollisionShapeIndices=[plate],
        linkVisualShapeIndices=[-1], linkPositions=[[0, 0, 0]], linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0]], linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0], linkJointTypes=[p.JOINT_FIXED], linkJointAxis=[[0, 0, 1]],
    )  # fmt: skip
    p.enableJointForceTorqueSensor(stand, 0, 1)
    cube = solid(tmp_path, [0.1, 0, 1.27], 2.0)
    if anchored:
        for node in range(9):
            p.createSoftBodyAnchor(cube, node, stand, 0)
    for _ in range(960):
        p.stepSimulation()
    force = np.array(p.getJointState(stand, 0)[2])
    # Its own weight of 10 N as well; the torque is that of 20 N at 0.1 m.
    assert force[:3] == pytest.approx([0, 0, 30], abs=0.2)
    assert force[3:] == pytest.approx([0, -2, 0], abs=0.1)
