"""What the fuzzers found, as tests that take no time."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator
from contextlib import suppress
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pybullet as p
import pybullet_data
from carom.world_files import container
from pybullet._logs.log_files import BinaryLog

CYLINDER = """<robot name="thin"><link name="base"><collision><geometry>
<cylinder radius="0.015" length="{length}"/></geometry></collision></link></robot>"""
HULL = """<robot name="hull"><link name="base"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><mesh filename="hull.obj"/></geometry></collision></link></robot>"""
COLLADA = """<COLLADA version="1.4.1" xmlns="http://www.collada.org/2005/11/COLLADASchema">
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="{stride}"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="{offset}"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#scene"/></scene></COLLADA>"""


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield number
    p.disconnect(number)


@pytest.fixture
def arm(client: int) -> int:
    return p.loadURDF("kuka_iiwa/model.urdf")


def test_a_log_with_columns_beyond_all_memory_is_refused(client: int, tmp_path: Path) -> None:
    path = tmp_path / "robots.bin"
    with pytest.raises(p.error, match="maxLogDof is 2147483647"):
        p.startStateLogging(p.STATE_LOGGING_GENERIC_ROBOT, str(path), maxLogDof=2**31 - 1)
    assert not path.exists()


def test_arrays_where_numbers_belong_are_refused(arm: int) -> None:
    vectors: Any = [np.array([1.0, 2.0])] * 3
    calls: list[Callable[[], Any]] = [
        lambda: p.setJointMotorControlMultiDof(arm, 0, p.POSITION_CONTROL, [0.0], force=vectors),
        lambda: p.setJointMotorControlMultiDof(arm, 0, p.POSITION_CONTROL, vectors),
        lambda: p.calculateJacobian(arm, 6, [0, 0, 0], vectors, vectors, vectors),
        lambda: p.calculateMassMatrix(arm, vectors),
    ]
    for call in calls:
        with pytest.raises((p.error, TypeError)):
            call()


@pytest.mark.filterwarnings("ignore:Conversion of an array:DeprecationWarning")
def test_orientations_with_arrays_of_one_number(arm: int) -> None:
    turn: Any = [0, 1, 0, np.array([0.0])]
    # It depends on the version of NumPy whether these can be converted to numbers.
    with suppress(p.error):
        found = p.calculateInverseKinematics(arm, 6, [0.4, 0, 0.5], turn)
        assert found == p.calculateInverseKinematics(arm, 6, [0.4, 0, 0.5], [0, 1, 0, 0])


def test_a_refused_quaternion_leaves_the_joints_before_it(client: int) -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    zeros, turns = [[0, 0, 0]] * 2, [[0, 0, 0, 1]] * 2
    body = p.createMultiBody(
        1, ball, linkMasses=[1, 1], linkCollisionShapeIndices=[ball] * 2, linkVisualShapeIndices=[-1] * 2,
        linkPositions=[[0, 0, 1], [0, 0, 1]], linkOrientations=turns, linkInertialFramePositions=zeros,
        linkInertialFrameOrientations=turns, linkParentIndices=[0, 1],
        linkJointTypes=[p.JOINT_REVOLUTE, p.JOINT_SPHERICAL], linkJointAxis=[[0, 0, 1]] * 2,
    )  # fmt: skip
    with pytest.raises(p.error, match="is no rotation"):
        p.resetJointStatesMultiDof(body, [0, 1], [[0.2], [0, 6e-301, 0, 8e-301]])
    with pytest.raises(p.error, match="is no rotation"):
        p.resetJointStateMultiDof(body, 1, [0, 0, 0, 0])
    assert p.getJointState(body, 0)[0] == 0.0
    p.resetJointStatesMultiDof(body, [0, 1], [[0.2], [0, 0.6, 0, 0.8]])
    assert p.getJointStateMultiDof(body, 1)[0] == pytest.approx((0, 0.6, 0, 0.8))


@pytest.mark.parametrize("flags", [0, 1])
@pytest.mark.parametrize("size", [1e100, 1e160, 1e299, 1.7e308])
@pytest.mark.parametrize("name", ["kuka_iiwa/model.urdf", "franka_panda/panda.urdf", "cartpole.urdf"])
def test_dynamics_of_numbers_beyond_all_bounds(client: int, name: str, size: float, flags: int) -> None:
    robot = p.loadURDF(name)
    joints = p.computeDofCount(robot)
    here, fast, still = [0, 0, 0, 0, 0, 0, 1] + [size] * joints, [size] * (joints + 6), [0] * (joints + 6)
    calls: list[Callable[[], Any]] = [
        lambda: p.calculateInverseDynamics(robot, here, [*fast, 0][: len(here)], fast, flags),
        lambda: p.calculateInverseDynamics(robot, here, [*fast, 0][: len(here)], still, flags),
        lambda: p.calculateInverseDynamics(robot, here, fast, still, flags),
        lambda: p.calculateMassMatrix(robot, here[7:], flags),
        lambda: p.calculateMassMatrix(robot, here, flags),
        lambda: p.calculateJacobian(robot, joints - 1, [size] * 3, here[7:], here[7:], here[7:]),
    ]
    for call in calls:
        with suppress(p.error):
            assert np.isfinite(np.hstack(call()).ravel()).all()


def test_logs_take_numbers_that_single_precision_does_not(client: int, tmp_path: Path) -> None:
    log = BinaryLog(tmp_path / "far.bin", ["far"], "f")
    log.before_step()
    log._write(1e300)
    log.after_step()
    log.close()
    assert (tmp_path / "far.bin").read_bytes().endswith(struct.pack("<f", np.inf))


def test_a_fraction_beyond_all_angles_is_refused() -> None:
    with pytest.raises(p.error, match=r"interpolationFraction is 1\.7e\+308"):
        p.getQuaternionSlerp([0.1, 0.2, 0.3, 0.9], [0.4, -0.2, 0.1, 0.7], 1.7e308)


def test_a_motor_is_left_alone_by_arguments_that_are_refused(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, targetPosition=0.3)
    motors = _motors(arm)
    with pytest.raises(TypeError, match="targetPosition"):
        p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, targetPosition=np.array([1.0, 2.0]))  # type: ignore[arg-type]
    assert _motors(arm) == motors


def test_a_joint_stays_where_it_is_if_its_velocity_is_refused(arm: int) -> None:
    before = p.getJointState(arm, 0)
    with pytest.raises(TypeError, match="targetVelocity"):
        p.resetJointState(arm, 0, 0.7, targetVelocity=np.array([1.0, 2.0]))  # type: ignore[arg-type]
    assert p.getJointState(arm, 0) == before


def test_a_log_may_be_written_to_a_device(arm: int) -> None:
    p.setPhysicsEngineParameter(numSubSteps=3)
    p.startStateLogging(p.STATE_LOGGING_GENERIC_ROBOT, "/dev/null")
    # So many contacts at once that a step has to be begun anew.
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    p.createMultiBody(1.0, ball, batchPositions=[(0.0, 0.0, 0.01 * place) for place in range(40)])
    p.stepSimulation()


def test_a_velocity_over_no_time_is_refused() -> None:
    with pytest.raises(p.error, match="deltaTime"):
        p.calculateVelocityQuaternion([0, 0, 0, 1], [0, 0, 0.6, 0.8], 5e-324)


@pytest.mark.parametrize("length", ["1e-320", "1e-200", "0"])
def test_cylinders_as_thin_as_nothing(client: int, tmp_path: Path, length: str) -> None:
    file = tmp_path / "thin.urdf"
    file.write_text(CYLINDER.format(length=length))
    p.loadURDF(str(file))
    p.stepSimulation()


@pytest.mark.parametrize(("stride", "offset"), [("3", "-1"), ("0", "0"), ("1e300", "0"), ("3", "1e300")])
def test_meshes_of_impossible_columns(client: int, tmp_path: Path, stride: str, offset: str) -> None:
    file = tmp_path / "mesh.dae"
    file.write_text(COLLADA.format(stride="3", offset="0"))
    assert p.createCollisionShape(p.GEOM_MESH, fileName=str(file)) >= 0
    file.write_text(COLLADA.format(stride=stride, offset=offset))
    with pytest.raises(p.error, match="has to be from"):
        p.createCollisionShape(p.GEOM_MESH, fileName=str(file))


def test_saved_worlds_with_immense_numbers(client: int, tmp_path: Path) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.123])
    p.createMultiBody(1.0, box)
    file = tmp_path / "world.bullet"
    p.saveBullet(str(file))
    document, blocks = container.unpacked(file.read_bytes(), file)
    text = json.dumps(document).replace("0.123", "1e308").encode()
    payload = struct.pack("<Q", len(text)) + text + bytes(blocks)
    header = struct.pack("<8sIIQ32s", container.MAGIC, 1, 0, len(payload), sha256(payload).digest())
    file.write_bytes(header + payload)
    p.resetSimulation()
    with pytest.raises(p.error, match=r"1e\+308"):
        p.loadBullet(str(file))
    assert p.getNumBodies() == 0


@pytest.mark.parametrize("robot", ["cube_small.urdf", "spherical_joint_limit.urdf"])
@pytest.mark.parametrize("damage", [1e228, 0.0])
def test_saved_worlds_whose_bodies_are_nowhere(
    client: int, tmp_path: Path, robot: str, damage: float
) -> None:
    p.loadURDF(robot, [0, 0, 0.6])
    file = tmp_path / "world.bullet"
    p.saveBullet(str(file))
    document, blocks = container.unpacked(file.read_bytes(), file)
    blocks = bytearray(blocks)
    place = document["state"]["state"]["position"]["at"]
    # The last quaternion of the body.
    count = document["state"]["state"]["position"]["shape"][0]
    blocks[place + 8 * (count - 4) : place + 8 * count] = struct.pack("<4d", *[damage] * 4)
    text = json.dumps(document).encode()
    payload = struct.pack("<Q", len(text)) + text + bytes(blocks)
    header = struct.pack("<8sIIQ32s", container.MAGIC, 1, 0, len(payload), sha256(payload).digest())
    file.write_bytes(header + payload)
    with pytest.raises(p.error, match=r"very large|quaternion"):
        p.restoreState(fileName=str(file))
    p.resetSimulation()
    with pytest.raises(p.error, match=r"very large|quaternion"):
        p.loadBullet(str(file))
    assert p.getNumBodies() == 0


@pytest.mark.parametrize("size", [1e15, 1e30, 1e31])
def test_hulls_so_large_that_their_normal_is_lost(client: int, tmp_path: Path, size: float) -> None:
    corners = "".join(f"v {x} {y} {z}\n" for x, y, z in product((-size, size), repeat=3))
    (tmp_path / "hull.obj").write_text(corners + "f 1 2 4\nf 5 7 8\nf 1 5 6\nf 3 4 8\n")
    (tmp_path / "hull.urdf").write_text(HULL)
    for position in ([0.3, 0.2, 0.1], [0.7, 0.2, -3.1]):
        p.loadURDF(str(tmp_path / "hull.urdf"), position)
    for _ in range(3):
        p.stepSimulation()
    points = [p.getContactPoints(), p.getClosestPoints(0, 1, 1.0)]
    lengths = [np.linalg.norm(point[7]) for found in points for point in found]
    assert lengths == pytest.approx([1.0] * len(lengths))


def _moments_of_capsule(radius: float) -> np.ndarray:
    capsule = p.createCollisionShape(p.GEOM_CAPSULE, radius=radius, height=radius)
    body = p.createMultiBody(1.0, capsule, basePosition=[0, 0, 1])
    return np.diag(p.calculateMassMatrix(body, [0, 0, 1, 0, 0, 0, 1], flags=1))[3:6]


@pytest.mark.parametrize("radius", [1e-9, 1e-120])
def test_mass_matrices_of_capsules_as_small_as_nothing(client: int, radius: float) -> None:
    expected = _moments_of_capsule(1.0) * radius**2
    assert _moments_of_capsule(radius) == pytest.approx(expected, rel=1e-12, abs=0.0)
    assert np.isfinite(_moments_of_capsule(5e-324)).all()


def _motors(body: int) -> list[float]:
    from pybullet._clients.clients import clients

    world = clients[0].world
    return world.motor[world.bodies[body].first_velocity :].ravel().tolist()


@pytest.mark.parametrize("name", ["x" * 5000, "x\0y"])
def test_a_mesh_to_simulate_may_have_any_name(client: int, name: str) -> None:
    with pytest.raises(p.error, match="was not found"):
        p.loadSoftBody("cloth_z_up.obj", simFileName=name)
    assert p.getNumBodies() == 0
