"""saveWorld: the script rebuilds the scene."""

from collections.abc import Iterator
from pathlib import Path

import pytest

import pybullet as p
import pybullet_data
from pybullet_utils.bullet_client import BulletClient

SDF = """<sdf version="1.6"><world name="w">{models}</world></sdf>"""
MODEL = """<model name="{name}"><pose>{x} 0 1 0 0 0.5</pose><link name="l"><inertial><mass>1</mass>
<inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial><collision name="c"><geometry><box>
<size>0.1 0.1 0.1</size></box></geometry></collision></link></model>"""


@pytest.fixture
def client() -> Iterator[int]:
    number = p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield number
    for each in range(3):
        if p.isConnected(each):
            p.disconnect(each)


def told(client: int) -> list[tuple]:
    """What can be read of all bodies and constraints."""
    bodies = [p.getBodyUniqueId(index, client) for index in range(p.getNumBodies(client))]
    ties = [p.getConstraintUniqueId(index, client) for index in range(p.getNumConstraints(client))]
    places = {body: place for place, body in enumerate(bodies)}
    return [
        (
            p.getBasePositionAndOrientation(body, client),
            p.getBaseVelocity(body, client),
            [
                p.getJointStateMultiDof(body, joint, client)[:2]
                for joint in range(p.getNumJoints(body, client))
            ],
            [
                p.getCollisionShapeData(body, joint, client)[0][2:]
                for joint in (-1,)
                if p.getCollisionShapeData(body, joint, client)
            ],
            p.getDynamicsInfo(body, -1, client)[:5],
        )
        for body in bodies
    ] + [
        (places[info[0]], places.get(info[2]), info[1], *info[3:])
        for info in (p.getConstraintInfo(tie, client) for tie in ties)
    ]


def rebuilt(script: Path) -> int:
    """Runs what a script does after connecting in a connection of its own; returns that."""
    wrapped = BulletClient(p.DIRECT)
    _, _, calls = script.read_text().partition("bodies = {}")
    exec(calls, {"p": wrapped, "bodies": {}})
    client, wrapped._client = wrapped._client, -1
    return client


def test_a_scene_of_every_kind_of_body(client: int, tmp_path: Path) -> None:
    sdf = tmp_path / "models.sdf"
    sdf.write_text(SDF.format(models="".join(MODEL.format(name=f"m{x}", x=x) for x in range(3))))
    p.loadURDF("plane.urdf")
    arm = p.loadURDF("kuka_iiwa/model.urdf", [1, 0, 0], [0, 0, 1, 1], useFixedBase=1)
    cube = p.loadURDF("cube_small.urdf", [0, 1, 1], globalScaling=2, flags=p.URDF_USE_SELF_COLLISION)
    models = p.loadSDF(str(sdf), globalScaling=1.5)
    p.removeBody(models[1])
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.2)
    seen = p.createVisualShape(p.GEOM_CYLINDER, radius=0.2, length=0.7, visualFramePosition=[0, 0, 0.1])
    parts = p.createCollisionShapeArray(
        [p.GEOM_BOX, p.GEOM_CAPSULE],
        radii=[0, 0.1],
        halfExtents=[[0.1, 0.2, 0.3], [1, 1, 1]],
        lengths=[0, 0.4],
        collisionFramePositions=[[0, 0, 0.5], [0, 0, 0]],
        collisionFrameOrientations=[[0, 0, 0, 1], [1, 0, 0, 0]],
    )
    hull = p.createCollisionShape(p.GEOM_MESH, vertices=[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    field = p.createCollisionShape(
        p.GEOM_HEIGHTFIELD,
        heightfieldData=[0, 0.1, 0.2, 0, 0.3, 0],
        numHeightfieldRows=3,
        numHeightfieldColumns=2,
        meshScale=[0.5, 0.5, 1],
    )
    p.createMultiBody(0, field, -1, [0, 0, -3])
    p.createMultiBody(2, hull, -1, [5, 5, 5])
    p.createMultiBody(
        1,
        ball,
        seen,
        [0, 0, 4],
        [0, 0, 0, 1],
        [0.05, 0, 0],
        linkMasses=[1, 2, 3],
        linkCollisionShapeIndices=[parts, ball, -1],
        linkVisualShapeIndices=[-1, -1, -1],
        linkPositions=[[0, 0, 0.5], [0, 0.1, 0.5], [0.5, 0, 0]],
        linkOrientations=[[0, 0, 0, 1]] * 3,
        linkInertialFramePositions=[[0, 0, 0.1]] * 3,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * 3,
        linkParentIndices=[0, 1, 0],
        linkJointTypes=[p.JOINT_REVOLUTE, p.JOINT_SPHERICAL, p.JOINT_PRISMATIC],
        linkJointAxis=[[0, 0, 2], [1, 0, 0], [1, 0, 0]],
    )
    tie = p.createConstraint(cube, -1, arm, 3, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0.1], [0, 0, 0.2])
    p.changeConstraint(tie, maxForce=70)
    p.setGravity(0, 0, -5)
    p.setTimeStep(1 / 100)
    for _ in range(15):
        p.stepSimulation()
    script = tmp_path / "scene.py"
    p.saveWorld(str(script))
    assert script.read_text().startswith("import pybullet as p\n")
    other = rebuilt(script)
    for new, old in zip(told(other), told(client), strict=True):
        assert repr(new) == repr(old)
    assert p.getPhysicsEngineParameters(other) == p.getPhysicsEngineParameters(client)
    for each in (client, other):
        p.stepSimulation(each)
    p.disconnect(other)


def test_the_script_runs_as_it_is(client: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    p.loadURDF("r2d2.urdf", [0, 0, 1])
    script = tmp_path / "scene.py"
    p.saveWorld(worldFileName=str(script))
    p.disconnect()
    monkeypatch.setattr(p, "GUI", p.DIRECT)
    exec(script.read_text(), {})
    assert p.getNumBodies() == 1
    assert p.getBasePositionAndOrientation(0)[0][2] == 1.0


def test_a_script_that_cannot_be_written(client: int, tmp_path: Path) -> None:
    with pytest.raises(p.error, match=r"^saveWorld command execution failed\."):
        p.saveWorld(str(tmp_path / "nowhere" / "scene.py"))
