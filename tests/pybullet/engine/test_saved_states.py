"""saveState, restoreState, removeState, saveBullet and loadBullet."""

from pathlib import Path

import pytest

import pybullet as p
import pybullet_data


@pytest.fixture
def scene():
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    p.loadURDF("plane.urdf")
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=1)
    cube = p.loadURDF("cube_small.urdf", [0.5, 0, 0.03])
    for joint in range(7):
        p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, 0.3)
    yield arm, cube
    p.disconnect()


def told(arm: int, cube: int) -> tuple:
    return (
        p.getJointStates(arm, range(7)),
        p.getBasePositionAndOrientation(cube),
        p.getBaseVelocity(cube),
        p.getContactPoints(),
    )


def run(arm: int, cube: int) -> tuple:
    for _ in range(30):
        p.stepSimulation()
    return told(arm, cube)


def test_a_state_can_be_restored_any_number_of_times(scene) -> None:
    run(*scene)
    state, start = p.saveState(), told(*scene)
    end = run(*scene)
    for _ in range(3):
        p.restoreState(state)
        assert told(*scene) == start
        assert run(*scene) == end


def test_wheels_go_on_with_the_points_they_had_gathered() -> None:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.8)
    p.loadURDF("plane.urdf")
    car = p.loadURDF("racecar/racecar.urdf", [0, 0, 0.05])
    for wheel in (2, 3):
        p.setJointMotorControl2(car, wheel, p.VELOCITY_CONTROL, targetVelocity=20, force=5)
    for hinge in (4, 6):
        p.setJointMotorControl2(car, hinge, p.POSITION_CONTROL, targetPosition=0.3, force=10)

    def drive() -> tuple:
        for _ in range(60):
            p.stepSimulation()
        return p.getBasePositionAndOrientation(car), p.getContactPoints()

    drive()
    state = p.saveState()
    end = drive()
    for _ in range(2):
        p.restoreState(state)
        assert drive() == end
    p.disconnect()


def test_motors_have_their_targets_back(scene) -> None:
    state = p.saveState()
    end = run(*scene)
    p.setJointMotorControl2(scene[0], 1, p.POSITION_CONTROL, -1.0)
    p.restoreState(stateId=state)
    assert run(*scene) == end


def test_ids_are_the_least_that_are_free(scene) -> None:
    assert [p.saveState() for _ in range(3)] == [0, 1, 2]
    p.removeState(1)
    p.removeState(77)
    assert (p.saveState(), p.saveState()) == (1, 3)
    p.removeState(2)
    p.removeState(stateUniqueId=0)
    assert [p.saveState() for _ in range(3)] == [0, 2, 4]


def test_a_reset_forgets_states(scene) -> None:
    p.saveState()
    p.resetSimulation()
    with pytest.raises(p.error, match=r"^Couldn't restore state\. There is no state 0"):
        p.restoreState(0)
    assert p.saveState() == 0
    p.restoreState(0)


def test_other_bodies_are_an_error_and_change_nothing(scene) -> None:
    _, cube = scene
    state = p.saveState()
    run(*scene)
    extra = p.loadURDF("cube_small.urdf", [0, 0, 3])
    before = told(*scene)
    with pytest.raises(p.error, match=r"^Couldn't restore state\. Body 3 was not there"):
        p.restoreState(state)
    assert told(*scene) == before
    p.removeBody(extra)
    p.restoreState(state)
    p.removeBody(cube)
    with pytest.raises(p.error, match=r"^Couldn't restore state\. Body 2 has been removed"):
        p.restoreState(state)
    assert p.loadURDF("cube_small.urdf", [7, 7, 7]) == cube
    p.restoreState(state)
    assert p.getBasePositionAndOrientation(cube)[0] == (0.5, 0.0, 0.03)


@pytest.mark.parametrize("arguments", [(), (5,), (-1,), (-1, "missing")])
def test_states_that_do_not_exist(scene, arguments: tuple) -> None:
    with pytest.raises(p.error, match=r"^Couldn't restore state\."):
        p.restoreState(*arguments)


def test_a_file_holds_the_state(scene, tmp_path: Path) -> None:
    file = str(tmp_path / "scene.bullet")
    run(*scene)
    p.saveBullet(file)
    end = run(*scene)
    p.restoreState(fileName=file)
    assert run(*scene) == end


def test_a_file_holds_the_scene(scene, tmp_path: Path) -> None:
    arm, cube = scene
    file = str(tmp_path / "scene.bullet")
    p.setTimeStep(1 / 500)
    p.setPhysicsEngineParameter(numSolverIterations=17)
    p.addUserData(cube, "colour", "green")
    p.changeVisualShape(cube, -1, rgbaColor=[0, 1, 0, 1])
    tie = p.createConstraint(cube, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0.5, 0, 0.5])
    run(*scene)
    p.saveBullet(bulletFileName=file)
    shapes = [p.getVisualShapeData(body) for body in range(3)]
    infos = [p.getJointInfo(arm, joint) for joint in range(7)]
    parameters = p.getPhysicsEngineParameters()
    end = run(*scene)
    p.resetSimulation()
    p.setTimeStep(1 / 240)
    assert p.loadBullet(file) == (0, 1, 2)
    assert p.getPhysicsEngineParameters() == parameters
    assert [p.getVisualShapeData(body) for body in range(3)] == shapes
    assert [p.getJointInfo(arm, joint) for joint in range(7)] == infos
    assert p.getUserData(p.getUserDataId(cube, "colour")) == b"green"
    assert p.getConstraintInfo(tie)[7] == (0.5, 0.0, 0.5)
    assert run(*scene) == end


def test_files_that_are_none(scene, tmp_path: Path) -> None:
    bad = tmp_path / "bad.bullet"
    bad.write_text("hello" * 100)
    with pytest.raises(p.error, match=r"^Couldn't load \.bullet file\. .*not a world saved by Carom"):
        p.loadBullet(str(bad))
    with pytest.raises(p.error, match=r"^Couldn't restore state\. .*not a world saved by Carom"):
        p.restoreState(fileName=str(bad))
    with pytest.raises(p.error, match=r"^Couldn't load \.bullet file\."):
        p.loadBullet("missing")
    with pytest.raises(p.error, match=r"^Couldn't save \.bullet file\."):
        p.saveBullet(str(tmp_path / "nowhere" / "x"))
    assert p.getNumBodies() == 3


@pytest.mark.insides
def test_saving_and_removing_states_does_not_pile_up(scene) -> None:
    from pybullet._clients.clients import clients

    for _ in range(10_000):
        p.removeState(p.saveState())
    assert not clients[0].states
    assert p.saveState() == 0
