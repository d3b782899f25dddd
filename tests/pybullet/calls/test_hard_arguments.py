"""Arguments that no script should have, and that must not get far."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import inf, isfinite, nan
from time import perf_counter
from typing import Any

import numpy as np
import pytest

import pybullet as p
import pybullet_data

SMALL = [1e-160, 0, 0, 0]
TINY = [0, 0, 0, 1e-200]
MANY = np.array([1.0, 2.0, 3.0])


@pytest.fixture(autouse=True)
def _scene() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=1)
    yield
    p.disconnect()


def box() -> int:
    return p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])


ROTATIONS: list[Callable[[list[float]], Any]] = [
    lambda turn: p.loadURDF("cube_small.urdf", [0, 0, 1], turn),
    lambda turn: p.resetBasePositionAndOrientation(1, [0, 0, 1], turn),
    lambda turn: p.createMultiBody(0, box(), -1, [0, 0, 1], turn),
    lambda turn: p.createMultiBody(1, box(), baseInertialFrameOrientation=turn),
    lambda turn: p.createCollisionShape(p.GEOM_SPHERE, radius=1, collisionFrameOrientation=turn),
    lambda turn: p.createVisualShape(p.GEOM_SPHERE, radius=1, visualFrameOrientation=turn),
    lambda turn: p.createConstraint(1, 0, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0, 0, 0], turn, turn),
    lambda turn: p.calculateInverseKinematics(1, 6, [0.3, 0, 0.5], turn),
    p.getMatrixFromQuaternion,
    lambda turn: p.multiplyTransforms([0, 0, 0], turn, [0, 0, 0], [0, 0, 0, 1]),
    lambda turn: p.invertTransform([0, 0, 0], turn),
]


@pytest.mark.parametrize("turn", [SMALL, TINY, [0, 0, 0, 0], [1e160, 0, 0, 0]])
@pytest.mark.parametrize("use", ROTATIONS)
def test_quaternions_without_direction_are_refused(use: Callable[[Any], Any], turn: list[float]) -> None:
    with pytest.raises(p.error, match=r"quaternion of length|has to be from"):
        use(turn)


@pytest.mark.parametrize("use", ROTATIONS)
def test_quaternions_of_other_lengths_are_rotations(use: Callable[[Any], Any]) -> None:
    use([0, 0, 0, 1e-9])
    use([0, 0, 3e9, 4e9])


TOO_LARGE: list[Callable[[], Any]] = [
    lambda: p.createMultiBody(1e300, box()),
    lambda: p.changeDynamics(1, 0, mass=1e300),
    lambda: p.changeDynamics(1, 0, localInertiaDiagonal=[1, 1, 1e300]),
    lambda: p.changeDynamics(1, 0, contactStiffness=1e300, contactDamping=1),
    lambda: p.createCollisionShape(p.GEOM_MESH, fileName="cube.obj", meshScale=[1e155] * 3),
    lambda: p.createCollisionShape(p.GEOM_MESH, vertices=[[1e155, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]]),
    lambda: p.createVisualShape(p.GEOM_MESH, fileName="cube.obj", meshScale=[1e300] * 3),
    lambda: p.loadURDF("cube_small.urdf", globalScaling=1e300),
    lambda: p.loadSDF("kuka_iiwa/model.sdf", globalScaling=1e300),
    lambda: p.resetJointState(1, 0, 1e300),
    lambda: p.resetBaseVelocity(1, [0, 0, 1e300]),
    lambda: p.setGravity(0, 0, 1e300),
    lambda: p.setPhysicsEngineParameter(contactERP=1e300),
    lambda: p.setJointMotorControl2(1, 0, p.POSITION_CONTROL, targetPosition=1e300),
    lambda: p.rayTestBatch([[0, 0, 0]], [[0, 0, 1e300]]),
]


@pytest.mark.parametrize("call", TOO_LARGE)
def test_what_products_would_overflow_is_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(p.error, match=r"1e\+30"):
        call()
    assert p.getNumBodies() == 2


def test_bounds_may_be_as_great_as_one_likes() -> None:
    p.setJointMotorControl2(1, 0, p.POSITION_CONTROL, targetPosition=0.1, force=1e300)
    p.changeDynamics(1, 0, jointLimitForce=1e100, maxJointVelocity=1e100)
    for _ in range(5):
        p.stepSimulation()
    assert all(map(isfinite, p.getJointState(1, 0)[:2]))


# The velocities in PyBullet of a hinge after one step: the greatest, or that of an unlimited motor.
_GREAT_FORCES: dict[str, tuple[Callable[[float], Any], float]] = {
    "torque on a link": (lambda f: p.applyExternalTorque(0, 0, [0, 0, f], p.WORLD_FRAME), 100.0),
    "torque of an array": (lambda f: p.applyExternalTorque(0, 0, np.array([0, 0, f]), p.LINK_FRAME), 100.0),
    "force beside the centre": (
        lambda f: p.applyExternalForce(0, 0, [0, f, 0], [1, 0, 0], p.WORLD_FRAME),
        100.0,
    ),
    "motor": (lambda f: p.setJointMotorControl2(0, 0, p.TORQUE_CONTROL, force=f), 100.0),
    "motors": (lambda f: p.setJointMotorControlArray(0, [0], p.TORQUE_CONTROL, forces=[f]), 100.0),
    "motor of lists": (
        lambda f: p.setJointMotorControlMultiDof(0, 0, p.POSITION_CONTROL, targetPosition=[1], force=[f]),
        24.0,
    ),
    "motors of lists": (
        lambda f: p.setJointMotorControlMultiDofArray(
            0, [0], p.POSITION_CONTROL, targetPositions=[[1]], forces=[[f]]
        ),
        24.0,
    ),
}


@pytest.mark.parametrize("force", [1e29, 1e31, 1e100, 1e300])
@pytest.mark.parametrize("case", _GREAT_FORCES)
def test_forces_may_be_as_great_as_one_likes(case: str, force: float) -> None:
    push, velocity = _GREAT_FORCES[case]
    p.resetSimulation()
    p.createMultiBody(
        linkMasses=[1], linkCollisionShapeIndices=[-1], linkVisualShapeIndices=[-1],
        linkPositions=[[0, 0, 0]], linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0]], linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0], linkJointTypes=[p.JOINT_REVOLUTE], linkJointAxis=[[0, 0, 1]],
    )  # fmt: skip
    p.changeDynamics(0, 0, localInertiaDiagonal=[1, 1, 1])
    p.setJointMotorControl2(0, 0, p.VELOCITY_CONTROL, force=0)
    push(force)
    p.stepSimulation()
    assert p.getJointState(0, 0)[1] == pytest.approx(velocity, abs=1e-3)


@pytest.mark.parametrize(
    "call",
    [
        lambda: p.applyExternalForce(1, 0, [inf, 0, 0], [0, 0, 0], p.WORLD_FRAME),
        lambda: p.applyExternalForce(1, 0, [0, 0], [0, 0, 0], p.WORLD_FRAME),
        lambda: p.applyExternalForce(1, 0, [1, 0, 0], [1e300, 0, 0], p.WORLD_FRAME),
        lambda: p.applyExternalTorque(1, 0, [0, nan, 0], p.WORLD_FRAME),
        lambda: p.setJointMotorControlMultiDof(1, 0, p.TORQUE_CONTROL, force=[inf]),
        lambda: p.setJointMotorControlMultiDofArray(
            1, [0], p.POSITION_CONTROL, targetPositions=[[1e300]], forces=[[1]]
        ),
    ],
)
def test_other_numbers_of_forces_are_refused(call: Callable[[], Any]) -> None:
    with pytest.raises(p.error, match=r"needs a 3|expected a"):
        call()


@pytest.mark.parametrize("scale", [1e-82, 1e-201, 1e-160, 5e-324])
def test_tiny_shapes_are_shapes(scale: float) -> None:
    shapes = [
        p.createCollisionShape(p.GEOM_MESH, fileName="cube.obj", meshScale=[scale] * 3),
        p.createCollisionShape(p.GEOM_CYLINDER, radius=scale, height=1),
    ]
    bodies = [p.createMultiBody(1, shape, basePosition=[0, 0, 3]) for shape in shapes]
    bodies.append(p.loadURDF("duck_vhacd.urdf", [0, 3, 3], globalScaling=scale))
    for _ in range(10):
        p.stepSimulation()
    for body in bodies:
        assert all(map(isfinite, p.getBasePositionAndOrientation(body)[0]))


ARRAYS: list[Callable[[], Any]] = [
    lambda: p.changeDynamics(1, -1, mass=MANY),  # type: ignore[arg-type]
    lambda: p.changeDynamics(1, -1, jointLowerLimit=MANY),  # type: ignore[arg-type]
    lambda: p.setJointMotorControl2(1, 0, p.POSITION_CONTROL, targetPosition=MANY),  # type: ignore[arg-type]
    lambda: p.resetJointState(1, 0, MANY),  # type: ignore[arg-type]
    lambda: p.calculateInverseKinematics(1, 6, [0, 0, 1], maxNumIterations=MANY),  # type: ignore[arg-type]
    lambda: p.calculateInverseKinematics(1, 6, [0, 0, 1], residualThreshold=MANY),  # type: ignore[arg-type]
    lambda: p.setTimeStep(MANY),  # type: ignore[arg-type]
]


@pytest.mark.parametrize("call", ARRAYS)
def test_arrays_are_no_numbers(call: Callable[[], Any]) -> None:
    with pytest.raises(TypeError, match=r"real number|integer"):
        call()


@pytest.mark.parametrize(
    "parameters",
    [
        {"numNonContactInnerIterations": 10**9},
        {"numSolverIterations": 10**9},
        {"numSubSteps": 10**9},
        {"numSolverIterations": 10**6, "numNonContactInnerIterations": 100},
        {"numSubSteps": 10_000, "numSolverIterations": 10_000},
    ],
)
def test_a_step_comes_to_an_end(parameters: dict[str, int]) -> None:
    before = p.getPhysicsEngineParameters()
    with pytest.raises(p.error, match="at most"):
        p.setPhysicsEngineParameter(**parameters)  # type: ignore[arg-type]
    assert p.getPhysicsEngineParameters() == before


def test_rays_end_behind_their_last_hit() -> None:
    p.rayTest([0, 0, 1], [0, 0, -1])
    start = perf_counter()
    hits = p.rayTestBatch([[9, 9, 1], [9, 9, 1]], [[9, 9, -1], [9, 9, 5]], reportHitNumber=2**31 - 1)
    assert [hit[0] for hit in hits] == [-1, -1]
    assert perf_counter() - start < 1.0


def test_without_iterations_nothing_is_solved() -> None:
    p.setGravity(0, 0, -10)
    cube = p.loadURDF("cube_small.urdf", [3, 3, 0.025])
    p.setJointMotorControl2(1, 3, p.POSITION_CONTROL, 0.5, force=100)
    for _ in range(30):
        p.stepSimulation()
    p.setPhysicsEngineParameter(numSolverIterations=0)
    held = p.getJointState(1, 3)[0]
    z = p.getBasePositionAndOrientation(cube)[0][2]
    for _ in range(60):
        p.stepSimulation()
    fallen = p.getBasePositionAndOrientation(cube)[0][2] - z
    # As in PyBullet: free fall by 60 steps of 1/240 s.
    assert fallen == pytest.approx(-10 * (60 * 61 / 2) / 240**2, rel=0.02)
    assert p.getJointState(1, 3)[3] == 0.0
    assert p.getJointState(1, 3)[0] != held


def test_states_do_not_depend_on_what_came_after_with_swept_spheres() -> None:
    p.setGravity(0, 0, -10)
    ball = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.05), basePosition=[2, 2, 3])
    p.changeDynamics(ball, -1, ccdSweptSphereRadius=0.05)
    p.resetBaseVelocity(ball, [0, 0, -30])
    for _ in range(10):
        p.stepSimulation()
    state = p.saveState()

    def after() -> list[Any]:
        poses = []
        for _ in range(20):
            p.stepSimulation()
            poses.append(p.getBasePositionAndOrientation(ball))
        return poses

    first = after()
    p.resetBasePositionAndOrientation(ball, [50, 50, 50], [0, 0, 0, 1])
    p.stepSimulation()
    p.restoreState(state)
    assert after() == first


@pytest.mark.parametrize("key", ["\0", "a\0b", "\ud800"])
def test_user_data_hold_text(key: str) -> None:
    for given in ((key, "v"), ("k", key)):
        with pytest.raises(p.error, match=r"null character|cannot be encoded"):
            p.addUserData(0, *given)
    assert p.getNumUserData(0) == 0


@pytest.mark.parametrize("name", ["x" * 300, "x" * 5000 + ".urdf", "a\0b", "\ud800", "no/" * 2000])
def test_names_no_file_can_have(name: str) -> None:
    loaders: list[Callable[[str], Any]] = [p.loadURDF, p.loadSDF, p.loadMJCF, p.loadBullet, p.loadTexture]
    for load in loaders:
        with pytest.raises(p.error):
            load(name)
    with pytest.raises(p.error):
        p.createCollisionShape(p.GEOM_MESH, fileName=name)
    assert p.loadPlugin(name) == -1


def test_null_space_lists_of_the_wrong_length_are_warned_of(caplog: pytest.LogCaptureFixture) -> None:
    plain = p.calculateInverseKinematics(1, 6, [0.4, 0.2, 0.6])
    lists: dict[str, Any] = {
        "lowerLimits": [-1] * 7,
        "upperLimits": [1] * 7,
        "jointRanges": [2] * 7,
        "restPoses": [0] * 6,
    }
    assert p.calculateInverseKinematics(1, 6, [0.4, 0.2, 0.6], lowerLimits=[], upperLimits=[]) == plain
    assert not caplog.records
    p.calculateInverseKinematics(1, 6, [0.4, 0.2, 0.6], **lists)
    assert "restPoses has 6 numbers, not 7" in caplog.text
