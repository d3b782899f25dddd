"""Loading and removing robots, engine parameters, dynamics of links."""

import logging
from pathlib import Path
from typing import Any

import pytest

import pybullet as p

ROBOTS = Path(__file__).parents[1] / "robots"


@pytest.mark.parametrize(
    ("arguments", "keywords"),
    [
        (([1, 2, 3],), {}),
        ((), {"basePosition": (1, 2, 3)}),
        ((1, 2, 3), {}),
        ((1, 2, 3, 0, 0, 0, 1), {}),
        ((), {"startPosX": 1, "startPosY": 2, "startPosZ": 3}),
        (([1, 2, 3], [0, 0, 0, 1], 0, 0, 0, 1.0, 0), {}),
        (([1, 2, 3], None), {"physicsClientId": 0}),
    ],
)
def test_poses_in_every_form(
    client: int, arm_path: str, arguments: tuple[Any, ...], keywords: dict[str, Any]
) -> None:
    body = p.loadURDF(arm_path, *arguments, **keywords)
    assert p.getBasePositionAndOrientation(body)[0] == (1.0, 2.0, 3.0)


def test_the_pose_is_that_of_the_link_frame(client: int) -> None:
    body = p.loadURDF(str(ROBOTS / "zoo.urdf"), [1, 1, 1])
    assert p.getBasePositionAndOrientation(body)[0] == pytest.approx((1.02, 0.99, 1.05))


@pytest.mark.parametrize(
    ("arguments", "keywords"),
    [
        ((), {}),
        ((5,), {}),
        ((b"arm.urdf",), {}),
        (("a", [0, 0, 0], [0, 0, 0, 1], 0, 0, 0, 1, 0, 0), {}),
        (("a",), {"foo": 1}),
        (("a", [0, 0, 0]), {"basePosition": [0, 0, 0]}),
        (("a",), {"useFixedBase": "yes"}),
        (("a",), {"flags": 1.5}),
    ],
)
def test_loading_with_arguments_it_does_not_have(
    client: int, arguments: tuple[Any, ...], keywords: dict[str, Any]
) -> None:
    with pytest.raises(TypeError):
        p.loadURDF(*arguments, **keywords)


def test_a_file_that_is_missing_or_broken(client: int, tmp_path: Path) -> None:
    with pytest.raises(p.error, match=r"^Cannot load URDF file\. .*nowhere\.urdf"):
        p.loadURDF("nowhere.urdf")
    with pytest.raises(p.error, match=r"^Empty filename, method expects 1, 4 or 8 arguments\."):
        p.loadURDF("")
    with pytest.raises(p.error, match=r"^Cannot load URDF file\."):
        p.loadURDF("nul\0.urdf")
    broken = tmp_path / "broken.urdf"
    broken.write_text('<robot name="r">\n<link name="a"/>\n<joint name="j" type="odd"/>\n</robot>')
    with pytest.raises(p.error, match=r"^Cannot load URDF file\. .*broken\.urdf:3"):
        p.loadURDF(str(broken))
    assert p.getNumBodies() == 0


def test_files_are_looked_for_in_the_additional_path(client: int) -> None:
    with pytest.raises(p.error):
        p.loadURDF("arm.urdf")
    p.setAdditionalSearchPath(str(ROBOTS))
    assert p.loadURDF("arm.urdf") == 0
    p.setAdditionalSearchPath(".")
    with pytest.raises(p.error):
        p.loadURDF("arm.urdf")


def test_scaling_of_nothing_or_less_is_none(client: int, arm_path: str) -> None:
    heights = []
    for scaling in (-1, 0, 1, 2):
        body = p.loadURDF(arm_path, globalScaling=scaling)
        state = p.getLinkState(body, 0)
        assert state is not None
        heights.append(state[4][2])
    assert heights == pytest.approx([0.05, 0.05, 0.05, 0.1])


@pytest.mark.parametrize("concave", [False, True])
def test_a_broken_mesh_loads_nothing(client: int, tmp_path: Path, concave: bool) -> None:
    # Without a mass nobody asks for the inertia of the mesh. What is concave needs triangles with an area.
    line = "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n" if concave else "v 0 0 0\nf 1 2 3\n"
    (tmp_path / "broken.obj").write_text(line)
    urdf, sdf = tmp_path / "floor.urdf", tmp_path / "floors.sdf"
    attribute = 'concave="yes"' if concave else ""
    urdf.write_text(
        '<robot name="floor"><link name="floor"><inertial><mass value="0"/>'
        '<inertia ixx="0" iyy="0" izz="0"/></inertial>'
        f'<collision {attribute}><geometry><mesh filename="broken.obj"/></geometry></collision>'
        "</link></robot>"
    )
    link = (
        '<link name="a"><inertial><mass>0</mass><inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia>'
        f'</inertial><collision name="c" {attribute}><geometry>{{}}</geometry></collision></link>'
    )
    shapes = ("<sphere><radius>1</radius></sphere>", "<mesh><uri>broken.obj</uri></mesh>")
    models = "".join(f'<model name="{shape[1]}">{link.format(shape)}</model>' for shape in shapes)
    sdf.write_text(f"<sdf><world>{models}</world></sdf>")
    for load, file, text in ((p.loadURDF, urdf, "URDF"), (p.loadSDF, sdf, "SDF")):
        with pytest.raises(p.error, match=f"Cannot load {text} file."):
            load(str(file))
        assert p.getNumBodies() == 0


def test_ids_of_removed_bodies_are_given_again(client: int, arm_path: str) -> None:
    assert [p.loadURDF(arm_path) for _ in range(4)] == [0, 1, 2, 3]
    p.removeBody(1)
    p.removeBody(2)
    p.removeBody(99)
    assert [p.getBodyUniqueId(place) for place in range(-1, 3)] == [-1, 0, 3, -1]
    assert [p.loadURDF(arm_path) for _ in range(3)] == [2, 1, 4]


def test_states_stay_with_their_bodies_when_others_go(client: int, arm_path: str) -> None:
    bodies = [p.loadURDF(arm_path, [number, 0, 0], useFixedBase=1) for number in range(40)]
    for body in bodies:
        p.resetJointState(body, 0, 0.01 * body)
        p.setJointMotorControl2(body, 0, p.POSITION_CONTROL, 0.01 * body)
    for body in bodies[::2]:
        p.removeBody(body)
    p.stepSimulation()
    for body in bodies[1::2]:
        assert p.getJointState(body, 0)[0] == pytest.approx(0.01 * body)
        assert p.getBasePositionAndOrientation(body)[0][0] == body
    with pytest.raises(p.error):
        p.getJointState(bodies[0], 0)


def test_names_are_bytes(zoo: int) -> None:
    assert p.getBodyInfo(zoo) == (b"trunk", b"zoo")


def test_resetting_keeps_the_time_step_alone(client: int, arm_path: str) -> None:
    p.setPhysicsEngineParameter(
        fixedTimeStep=0.01, numSubSteps=4, numSolverIterations=7, reportSolverAnalytics=1
    )
    p.setGravity(1, 2, 3)
    p.loadURDF(arm_path)
    p.resetSimulation()
    assert p.getPhysicsEngineParameters() == {
        "fixedTimeStep": 0.01,
        "numSubSteps": 4,
        "numSolverIterations": 50,
        "useRealTimeSimulation": 0,
        "gravityAccelerationX": 0.0,
        "gravityAccelerationY": 0.0,
        "gravityAccelerationZ": 0.0,
        "numNonContactInnerIterations": 1,
    }
    assert p.stepSimulation() == ()
    assert p.loadURDF(arm_path) == 0


def test_negative_parameters_change_nothing(client: int) -> None:
    p.setPhysicsEngineParameter(numSolverIterations=0, numSubSteps=0)
    before = p.getPhysicsEngineParameters()
    assert before["numSolverIterations"] == 0
    p.setPhysicsEngineParameter(fixedTimeStep=-2, numSolverIterations=-2, numNonContactInnerIterations=0)
    assert p.getPhysicsEngineParameters() == before


def test_a_motion_that_is_no_longer_finite_is_an_error_of_pybullet(client: int) -> None:
    body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    p.changeDynamics(body, -1, maxJointVelocity=1e308)
    # What spins about no principal axis turns its spin, here by more than numbers reach after some steps.
    p.changeDynamics(body, -1, localInertiaDiagonal=[1, 2, 3])
    p.resetBaseVelocity(body, angularVelocity=[1e30, 1e30, 1e30])
    with pytest.raises(p.error, match=r"body 0 .* not finite"):
        for _ in range(20):
            p.stepSimulation()
    assert p.getBasePositionAndOrientation(body)[0] == (0.0, 0.0, 0.0)


def test_statistics_of_the_solver_come_when_asked_for(arm: int) -> None:
    assert p.stepSimulation() == ()
    p.setPhysicsEngineParameter(reportSolverAnalytics=1)
    (island,) = p.stepSimulation()
    assert set(island) == {"islandId", "numBodies", "numIterationsUsed", "remainingResidual"}
    p.setPhysicsEngineParameter(reportSolverAnalytics=0)
    assert p.stepSimulation() == ()


def test_dynamics_are_those_of_the_file_until_changed(zoo: int) -> None:
    info = p.getDynamicsInfo(zoo, 0)
    assert info[:3] == (1.0, 0.7, (0.004, 0.02, 0.02))
    assert info[3] == (0.2, 0.0, 0.0)
    assert info[5:] == (0.0, 0.0, 0.0, -1.0, -1.0, 2, 0.001)
    assert p.getDynamicsInfo(zoo, -1)[0] == 0.0
    p.changeDynamics(
        zoo,
        0,
        lateralFriction=0.1,
        spinningFriction=0.2,
        rollingFriction=0.3,
        restitution=0.4,
        contactStiffness=10,
        contactDamping=5,
        localInertiaDiagonal=(1, 2, 3),
    )
    info = p.getDynamicsInfo(zoo, 0)
    assert info[1:3] == (0.1, (1.0, 2.0, 3.0))
    assert info[5:10] == (0.4, 0.3, 0.2, 5.0, 10.0)
    p.changeDynamics(zoo, 0)
    assert p.getDynamicsInfo(zoo, 0) == info


def test_joint_info_does_not_follow_changes(zoo: int) -> None:
    before = p.getJointInfo(zoo, 0)
    p.changeDynamics(zoo, 0, jointDamping=3, jointLowerLimit=-0.1, jointUpperLimit=0.1, jointLimitForce=5)
    assert p.getJointInfo(zoo, 0) == before


def test_what_is_changed_with_the_whole_body_goes_to_the_base(
    zoo: int, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING, logger="pybullet"):
        p.changeDynamics(zoo, 0, lateralFriction=0.9, linearDamping=0.1)
    assert p.getDynamicsInfo(zoo, 0)[1] == 0.7
    assert p.getDynamicsInfo(zoo, -1)[1] == 0.9
    assert "lateral_friction go to the base, not to link 0" in caplog.text
    # What is looked at last decides.
    p.changeDynamics(zoo, 0, lateralFriction=0.8, linearDamping=0.1, restitution=0.3)
    assert p.getDynamicsInfo(zoo, 0)[1] == 0.8
    p.changeDynamics(zoo, 0, collisionMargin=0.02)
    assert [p.getDynamicsInfo(zoo, link)[11] for link in (-1, 0)] == [0.02, 0.001]


def test_a_base_given_mass_is_free_and_without_it_fixed(zoo: int) -> None:
    p.setGravity(0, 0, -9.8)
    p.changeDynamics(zoo, -1, mass=2)
    p.stepSimulation()
    assert p.getBaseVelocity(zoo)[0][2] < 0.0
    p.changeDynamics(zoo, -1, mass=0)
    p.resetBaseVelocity(zoo, [0, 0, 0], [0, 0, 0])
    p.stepSimulation()
    assert p.getBaseVelocity(zoo)[0][2] == 0.0


def test_maximal_coordinates_are_not_there(
    client: int, arm_path: str, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING, logger="pybullet"):
        p.loadURDF(arm_path, useMaximalCoordinates=1)
    assert "useMaximalCoordinates" in caplog.text
