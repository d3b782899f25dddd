"""Soft bodies in the drop-in: what loads them, what the getters say, what is refused."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.soft.scenes import write_cube, write_grid

import pybullet as p
import pybullet_data

SPRINGS: dict[str, Any] = {"useMassSpring": 1, "springElasticStiffness": 40.0}


@pytest.fixture(autouse=True)
def connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    yield
    p.disconnect()


@pytest.fixture
def cloth(tmp_path: Path) -> int:
    path = write_grid(tmp_path / "cloth.obj", 9)
    return p.loadSoftBody(str(path), [0, 0, 1], mass=2.0, collisionMargin=0.01, **SPRINGS)


def nodes(body: int) -> np.ndarray:
    return np.array(p.getMeshData(body, flags=p.MESH_DATA_SIMULATION_MESH)[1])


@pytest.mark.parametrize("body", [0, 99])
@pytest.mark.parametrize(
    ("name", "arguments", "problem"),
    [
        ("resetMeshData", ([[0, 0, 0]],), r"^resetMeshData failed"),
        ("getTetraMeshData", (), r"^getTetraMeshData failed"),
        ("createSoftBodyAnchor", (0, -1, -1), r"^createSoftBodyAnchor failed\."),
    ],
)
def test_no_body_is_soft(name: str, arguments: tuple, problem: str, body: int) -> None:
    p.loadURDF("cube_small.urdf")
    with pytest.raises(p.error, match=problem):
        getattr(p, name)(body, *arguments)


def test_the_getters(cloth: int) -> None:
    assert (p.getNumBodies(), p.getNumJoints(cloth), p.getBodyInfo(cloth)[0]) == (1, 0, b"cloth")
    info = p.getDynamicsInfo(cloth, -1)
    assert (info[0], info[10], info[11]) == (pytest.approx(2.0), 3, 0.01)
    lower, upper = p.getAABB(cloth)
    assert lower == pytest.approx((-0.51, -0.51, 0.99)) and upper == pytest.approx((0.51, 0.51, 1.01))
    assert p.getMeshData(cloth)[0] == 3 * 128
    assert nodes(cloth).shape == (81, 3)
    assert p.getTetraMeshData(cloth) == (0, ())
    assert p.getVisualShapeData(cloth)[0][2] == p.GEOM_MESH
    assert p.getCollisionShapeData(cloth, -1) == ()


def test_defaults_are_those_of_pybullet(tmp_path: Path) -> None:
    body = p.loadSoftBody(str(write_grid(tmp_path / "cloth.obj", 3)))
    info = p.getDynamicsInfo(body, -1)
    assert (info[0], info[1], info[11]) == (pytest.approx(1.0), 0.0, 0.02)
    assert p.loadSoftBody("") == -1


def test_velocities_of_nodes(cloth: int) -> None:
    p.setGravity(0, 0, -10)
    for _ in range(24):
        p.stepSimulation()
    count, velocities = p.getMeshData(cloth, flags=8)
    assert count == 81
    assert np.array(velocities)[:, 2] == pytest.approx(-1.0)
    assert p.getBaseVelocity(cloth)[0] == pytest.approx((0, 0, -1.0))


def test_placing_it(cloth: int) -> None:
    p.resetBaseVelocity(cloth, [1, 2, 3])
    p.resetBasePositionAndOrientation(cloth, [1, 2, 3], p.getQuaternionFromEuler([0, 0, np.pi / 2]))
    assert p.getBasePositionAndOrientation(cloth)[0] == pytest.approx((1, 2, 3))
    assert p.getBaseVelocity(cloth)[0] == (0.0, 0.0, 0.0)
    assert nodes(cloth)[0] == pytest.approx([1.5, 1.5, 3.0])
    moved = nodes(cloth) + np.array([0, 0, 1])
    p.resetMeshData(cloth, moved.tolist())
    assert np.array_equal(nodes(cloth), moved)
    with pytest.raises(p.error, match=r"resetMeshData failed .* must have shape \(81, 3\)"):
        p.resetMeshData(cloth, [[0, 0, 0]])
    with pytest.raises(p.error, match="resetMeshData failed"):
        p.resetMeshData(cloth, (moved * np.nan).tolist())


def test_anchors_are_constraints(cloth: int) -> None:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    box = p.createMultiBody(1, shape, basePosition=[0, 0, 1])
    tie = p.createConstraint(box, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0, 0, 1])
    first, second = p.createSoftBodyAnchor(cloth, 0), p.createSoftBodyAnchor(cloth, 40, box, -1)
    numbers = [p.getConstraintUniqueId(index) for index in range(p.getNumConstraints())]
    assert numbers == [tie, first, second]
    assert p.getConstraintInfo(second)[:5] == (cloth, 40, box, -1, p.JOINT_POINT2POINT)
    p.removeConstraint(first)
    assert p.getNumConstraints() == 2
    p.removeBody(box)
    assert p.getNumConstraints() == 0
    for node, holder in ((-1, -1), (81, -1), (0, 77), (0, cloth)):
        with pytest.raises(p.error, match="createSoftBodyAnchor failed"):
            p.createSoftBodyAnchor(cloth, node, holder)


def test_forces_on_nodes(cloth: int) -> None:
    p.applyExternalForce(cloth, -1, [2.0, 0, 0], [0, 0, 0], p.WORLD_FRAME)
    p.stepSimulation()
    assert p.getBaseVelocity(cloth)[0] == pytest.approx((1.0 / 240, 0, 0))
    p.applyExternalForce(cloth, 40, [0, 0, 2.0], [0, 0, 0], p.WORLD_FRAME)
    p.stepSimulation()
    assert p.getBaseVelocity(cloth)[0] == pytest.approx((1.0 / 240, 0, 1.0 / 240))
    assert nodes(cloth)[:, 2].argmax() == 40
    with pytest.raises(p.error, match="Invalid link index"):
        p.applyExternalForce(cloth, 81, [1, 0, 0], [0, 0, 0], p.WORLD_FRAME)


def test_states(cloth: int, tmp_path: Path) -> None:
    p.setGravity(0, 0, -10)
    p.createSoftBodyAnchor(cloth, 0)
    p.stepSimulation()
    state, start = p.saveState(), nodes(cloth)
    p.saveBullet(str(tmp_path / "state.bullet"))
    for _ in range(20):
        p.stepSimulation()
    end = nodes(cloth)
    for number, file in ((state, None), (-1, str(tmp_path / "state.bullet"))):
        p.restoreState(number, file)
        assert np.array_equal(nodes(cloth), start)
        for _ in range(20):
            p.stepSimulation()
        assert np.array_equal(nodes(cloth), end)


def test_images_show_where_the_nodes_are(cloth: int) -> None:
    p.changeVisualShape(cloth, -1, rgbaColor=[1, 0, 0, 1])
    view = p.computeViewMatrix([0, -3, 1.0], [0, 0, 1.0], [0, 0, 1])
    projection = p.computeProjectionMatrixFOV(60, 1, 0.1, 10)

    def rows() -> np.ndarray:
        seen = np.reshape(p.getCameraImage(64, 64, view, projection)[4], (64, 64)) == cloth
        return np.flatnonzero(seen.any(axis=1))

    standing = nodes(cloth)[:, [0, 2, 1]] + [0, 1.0, 0.0]
    standing[:, 1], standing[:, 2] = 0.0, nodes(cloth)[:, 1] + 1.0
    p.resetMeshData(cloth, standing.tolist())
    first = rows()
    assert 15 < len(first) < 25
    p.resetMeshData(cloth, (standing + np.array([0, 0, 0.5])).tolist())
    assert rows().mean() < first.mean() - 5


def test_a_mesh_that_is_seen_follows_the_one_that_is_simulated(tmp_path: Path) -> None:
    write_cube(tmp_path / "inside.vtk", 2, 0.4)
    corners = ["v -0.2 -0.2 0.2", "v 0.2 -0.2 0.2", "v 0.2 0.2 0.2"]
    (tmp_path / "seen.obj").write_text("\n".join([*corners, "f 1 2 3"]) + "\n")
    body = p.loadSoftBody(
        str(tmp_path / "seen.obj"), simFileName="inside.vtk", mass=1.0, useNeoHookean=1, NeoHookeanMu=500,
        NeoHookeanLambda=500,
    )  # fmt: skip
    assert p.getMeshData(body, flags=1)[0] == 27
    start = np.array(p.getMeshData(body)[1])
    assert start[:, 2] == pytest.approx(0.2)
    moved = nodes(body) * [1.0, 1.0, 2.0]
    p.resetMeshData(body, moved.tolist())
    assert np.array(p.getMeshData(body)[1]) == pytest.approx(start * [1.0, 1.0, 2.0])


def test_cloth_outside_of_the_deformable_world(tmp_path: Path) -> None:
    p.resetSimulation()
    p.setGravity(0, 0, -10)
    with pytest.raises(p.error, match=r"Cannot load soft body\. .*RESET_USE_DEFORMABLE_WORLD"):
        p.loadSoftBody(str(write_cube(tmp_path / "cube.vtk", 2)))
    body = p.loadSoftBody(str(write_grid(tmp_path / "cloth.obj", 9)), mass=1.0)
    p.createSoftBodyAnchor(body, 0)
    p.createSoftBodyAnchor(body, 8)
    for _ in range(240):
        p.stepSimulation()
    # It hardly stretches.
    columns = nodes(body).reshape(9, 9, 3)
    lengths = np.linalg.norm(np.diff(columns, axis=0), axis=2).sum(axis=0)
    assert lengths == pytest.approx(1.0, abs=0.1)


def test_cloth_outside_of_the_deformable_world_hardly_stretches(tmp_path: Path) -> None:
    p.resetSimulation()
    p.setGravity(0, 0, -10)
    turned = p.getQuaternionFromEuler([np.pi / 2, 0, 0])
    body = p.loadSoftBody(str(write_grid(tmp_path / "cloth.obj", 9)), baseOrientation=turned, mass=1.0)
    for node in np.flatnonzero(nodes(body)[:, 2] > 0.49):
        p.createSoftBodyAnchor(body, int(node))
    for _ in range(960):
        p.stepSimulation()
    # PyBullet: -0.50004.
    assert nodes(body)[:, 2].min() == pytest.approx(-0.50004, abs=2e-4)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"fileName": "missing.obj"}, "The file 'missing.obj' was not found"),
        ({"fileName": "plane.urdf"}, "soft bodies are read from .obj, .vtk files, not .urdf"),
        ({"springElasticStiffness": -1.0, "useMassSpring": 1}, "the stiffness of springs is -1.0"),
        ({"frictionCoeff": -1.0}, "friction is -1.0"),
        ({"simFileName": "missing.vtk"}, "The file 'missing.vtk' was not found"),
    ],
)
def test_what_makes_no_sense_is_refused(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(p.error, match=rf"^Cannot load soft body\. .*{problem}"):
        p.loadSoftBody(**{"fileName": "cloth_z_up.obj", **arguments})
    assert p.getNumBodies() == 0


@pytest.mark.parametrize("name", ["cloth_z_up.obj", "bunny.obj", "cube.obj"])
def test_shipped_meshes_fall_and_lie(name: str) -> None:
    p.setGravity(0, 0, -10)
    p.loadURDF("plane.urdf")
    body = p.loadSoftBody(name, [0, 0, 1.5], mass=1.0, useBendingSprings=1, springBendingStiffness=20.0,
                          useMassSpring=1, springElasticStiffness=100.0, frictionCoeff=0.5)  # fmt: skip
    for _ in range(240):
        p.stepSimulation()
    assert np.isfinite(nodes(body)).all()
    assert nodes(body)[:, 2].min() == pytest.approx(0.02, abs=0.01)


def test_a_scene_is_written_as_a_script(cloth: int, tmp_path: Path) -> None:
    p.setGravity(0, 0, -10)
    box = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[0, 0, 2])
    p.createSoftBodyAnchor(cloth, 0)
    p.createSoftBodyAnchor(cloth, 80, box)
    for _ in range(20):
        p.stepSimulation()
    before = nodes(cloth)
    p.saveWorld(str(tmp_path / "scene.py"))
    p.resetSimulation()
    lines = (tmp_path / "scene.py").read_text().splitlines()
    script = "\n".join(line for line in lines if "connect" not in line and not line.startswith("if cin"))
    bodies: dict[str, dict[int, int]] = {}
    exec(script, bodies)
    assert nodes(bodies["bodies"][cloth]) == pytest.approx(before)
    assert p.getNumConstraints() == 2
    for _ in range(20):
        p.stepSimulation()
    assert nodes(bodies["bodies"][cloth])[0] == pytest.approx(before[0])


def test_what_bullets_examples_load() -> None:
    """Bodies, names and parameters are those of bullet3's `deformable_*.py`."""
    p.setGravity(0, 0, -10)
    p.loadURDF("plane.urdf", [0, 0, -2])
    solid: dict[str, Any] = {"useNeoHookean": 1, "useSelfCollision": 1, "frictionCoeff": 0.5}
    ball = p.loadSoftBody(
        "ball.obj", [0, 0, -1.2], simFileName="ball.vtk", scale=0.5, mass=4, NeoHookeanMu=400,
        NeoHookeanLambda=600, NeoHookeanDamping=0.001, collisionMargin=0.001, **solid,
    )  # fmt: skip
    ring = p.loadSoftBody(
        "torus/torus_textured.obj", [2, 0, -1.2], simFileName="torus.vtk", mass=3, NeoHookeanMu=180,
        NeoHookeanLambda=600, NeoHookeanDamping=0.01, collisionMargin=0.006, **solid,
    )  # fmt: skip
    other = p.loadURDF("torus_deform.urdf", [2, 0.6, -1.2], flags=p.URDF_USE_SELF_COLLISION)
    p.setPhysicsEngineParameter(sparseSdfVoxelSize=0.25)
    assert p.getMeshData(ball)[0] == 3 * 648
    for _ in range(96):
        p.stepSimulation()
    for body in (ball, ring, other):
        places = nodes(body)
        assert -2.0 <= places[:, 2].min() < -1.97
        assert np.ptp(places, axis=0).max() < 2.2


def test_balls_pressed_on_a_face_from_both_sides_are_kept_apart_and_hold_it(tmp_path: Path) -> None:
    """Two balls between the nodes of coarse cloth, each pressed by 3 N, bear it against its weight."""
    p.setGravity(0, -5, 0)
    sheet = p.loadSoftBody(
        str(write_grid(tmp_path / "sheet.obj", 3, 0.4)),
        mass=0.05,
        frictionCoeff=2.0,
        collisionMargin=0.01,
        **SPRINGS,
    )
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.02)
    balls = [p.createMultiBody(0.1, shape, basePosition=[0.1, 0.05, z]) for z in (-0.031, 0.031)]
    for ball in balls:
        p.changeDynamics(ball, -1, lateralFriction=1.0, linearDamping=0.0)
    for _ in range(60):
        for ball, side in zip(balls, (1, -1), strict=True):
            place = p.getBasePositionAndOrientation(ball)[0]
            # 0.5 N along y bear the ball.
            p.applyExternalForce(ball, -1, [0, 0.5, 3.0 * side], place, p.WORLD_FRAME)
        p.stepSimulation()
    below, above = (p.getBasePositionAndOrientation(ball)[0][2] for ball in balls)
    assert above - below > 0.04
    for ball in balls:
        assert sum(contact[9] for contact in p.getContactPoints(ball, sheet)) == pytest.approx(3.0, rel=0.1)
