"""Constraints made by scripts; the expected values are what PyBullet 3.2.7 answers."""

from collections.abc import Callable
from math import inf, nan
from typing import Any

import pytest
from tests.pybullet.contacts.touching import BALL, FLOOR, PAIR, balls

import pybullet as p

__all__ = ["balls"]

ORIGIN = [0.0, 0.0, 0.0]
TURN = (0.0, 0.0, 0.0, 1.0)
# Arguments of `createConstraint` that are right.
RIGHT: dict[str, Any] = {
    "parentBodyUniqueId": BALL,
    "parentLinkIndex": -1,
    "childBodyUniqueId": -1,
    "childLinkIndex": -1,
    "jointType": p.JOINT_POINT2POINT,
    "jointAxis": ORIGIN,
    "parentFramePosition": ORIGIN,
    "childFramePosition": [0.0, 0.0, 1.0],
}


def make(**changes: Any) -> int:
    return p.createConstraint(**{**RIGHT, **changes})


def weld() -> int:
    return make(
        childBodyUniqueId=FLOOR,
        jointType=p.JOINT_FIXED,
        jointAxis=[0, 0, 1],
        parentFramePosition=[0.1, 0, 0],
        childFramePosition=[0, 0, 1.1],
    )


@pytest.mark.usefixtures("balls")
def test_constraints_are_numbered_from_one() -> None:
    assert p.getNumConstraints() == 0
    assert (make(), weld()) == (1, 2)
    assert p.getNumConstraints() == 2
    assert [p.getConstraintUniqueId(index) for index in (0, 1, 2, -1)] == [1, 2, -1, -1]


@pytest.mark.usefixtures("balls")
def test_information_is_what_was_given() -> None:
    to_world, to_floor = p.getConstraintInfo(make()), p.getConstraintInfo(weld())
    assert to_world[:6] == (BALL, -1, -1, -1, p.JOINT_POINT2POINT, (0.0, 0.0, 0.0))
    assert to_world[6:12] == ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), TURN, TURN, 500.0, 0.0)
    assert to_floor[:6] == (BALL, -1, FLOOR, -1, p.JOINT_FIXED, (0.0, 0.0, 1.0))
    assert to_floor[6:12] == ((0.1, 0.0, 0.0), (0.0, 0.0, 1.1), TURN, TURN, 500.0, 0.0)


@pytest.mark.usefixtures("balls")
def test_changes_are_reported() -> None:
    constraint = make()
    p.changeConstraint(constraint, [0, 0, 2], maxForce=12.5)
    information = p.getConstraintInfo(constraint)
    assert information[7] == (0.0, 0.0, 2.0)
    assert information[10] == 12.5


@pytest.mark.usefixtures("balls")
def test_forces_of_two_constraints_that_fight() -> None:
    first, second = make(), weld()
    p.stepSimulation()
    assert p.getConstraintState(first) == pytest.approx((-28800.0, 0.0, -84434.95285714291), rel=1e-9)
    expected = (-28800.0, 0.0, -74057.14285714283, 0.0, -7405.714285714288, 0.0)
    assert p.getConstraintState(second) == pytest.approx(expected, rel=1e-9)


@pytest.mark.usefixtures("balls")
def test_forces_stay_with_their_constraint_when_others_come_and_go() -> None:
    first, second = make(), weld()
    p.stepSimulation()
    forces = p.getConstraintState(second)
    assert any(forces)
    p.removeConstraint(first)
    assert p.getConstraintState(second) == forces
    third = make()
    assert p.getConstraintState(third) == (0.0, 0.0, 0.0)
    p.changeConstraint(third, maxForce=2.0)
    assert p.getConstraintState(third) == (0.0, 0.0, 0.0)
    assert p.getConstraintState(second) == forces


@pytest.mark.usefixtures("balls")
def test_forces_are_those_of_the_last_step_when_the_time_step_changes() -> None:
    constraint = weld()
    p.stepSimulation()
    forces = p.getConstraintState(constraint)
    assert any(forces)
    p.setPhysicsEngineParameter(numSubSteps=4)
    assert p.getConstraintState(constraint) == pytest.approx(forces, rel=1e-12)
    p.setTimeStep(0.01)
    assert p.getConstraintState(constraint) == pytest.approx(forces, rel=1e-12)


@pytest.mark.usefixtures("balls")
def test_a_restored_state_has_the_forces_of_its_constraints() -> None:
    first, second = make(), weld()
    p.stepSimulation()
    forces = p.getConstraintState(second)
    p.removeConstraint(first)
    state = p.saveState()
    p.stepSimulation()
    assert p.getConstraintState(second) != forces
    p.restoreState(state)
    assert p.getConstraintState(second) == forces
    third = make()
    p.restoreState(p.saveState())
    assert p.getConstraintState(second) == forces
    assert p.getConstraintState(third) == (0.0, 0.0, 0.0)


@pytest.mark.usefixtures("balls")
def test_a_removed_constraint_holds_no_longer() -> None:
    constraint = make()
    for _ in range(240):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(BALL)[0][2] == pytest.approx(1.0, abs=0.01)
    p.removeConstraint(constraint)
    assert p.getNumConstraints() == 0
    for _ in range(240):
        p.stepSimulation()
    assert p.getBasePositionAndOrientation(BALL)[0][2] == pytest.approx(0.1, abs=1e-3)


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize("body", [FLOOR, BALL])
def test_constraints_go_with_their_bodies(body: int) -> None:
    constraint = weld()
    p.removeBody(body)
    assert p.getNumConstraints() == 0
    with pytest.raises(p.error, match="Couldn't get user constraint info"):
        p.getConstraintInfo(constraint)
    p.stepSimulation()


UNKNOWN: list[tuple[Callable[[int], Any], str | None]] = [
    (p.getConstraintInfo, "Couldn't get user constraint info"),
    (p.getConstraintState, r"Couldn't getConstraintState\."),
    (p.removeConstraint, None),
    (lambda number: p.changeConstraint(number, maxForce=1.0), None),
]


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize(("call", "problem"), UNKNOWN)
@pytest.mark.parametrize("number", [9, 0, -1])
def test_a_constraint_that_does_not_exist(
    call: Callable[[int], Any], problem: str | None, number: int
) -> None:
    before = p.getConstraintInfo(make())
    if problem is None:
        assert call(number) is None
    else:
        with pytest.raises(p.error, match=problem):
            call(number)
    assert p.getNumConstraints() == 1
    assert p.getConstraintInfo(1) == before


REFUSED: list[dict[str, Any]] = [
    {"parentBodyUniqueId": 99},
    {"parentBodyUniqueId": -1},
    {"parentLinkIndex": 5},
    {"parentLinkIndex": -2},
    {"childBodyUniqueId": 99},
    {"childBodyUniqueId": PAIR, "childLinkIndex": 1},
    {"jointType": 77},
    {"jointType": 7},  # a coupling of the modern API
    {"jointType": 8},
    {"jointType": p.JOINT_GEAR},
    {"jointAxis": [0.0, 0.0, nan]},
    {"parentFramePosition": [0.0, inf, 0.0]},
    {"childFramePosition": "abc"},
    {"parentFrameOrientation": [0.0, 0.0, 0.0, 0.0]},
    {"childFrameOrientation": [0.0, 0.0, nan, 1.0]},
]


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize("wrong", REFUSED)
def test_a_constraint_that_cannot_be(wrong: dict[str, Any]) -> None:
    with pytest.raises(p.error, match=r"createConstraint failed\."):
        make(**wrong)
    assert p.getNumConstraints() == 0
    assert make() == 1


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize("argument", [name for name in RIGHT if name.endswith(("Id", "Index", "Type"))])
def test_what_is_no_integer_is_refused(argument: str) -> None:
    for wrong in ("x", None, 0.5, [0]):
        with pytest.raises(TypeError, match=argument):
            make(**{argument: wrong})
    assert p.getNumConstraints() == 0


CHANGES: list[tuple[dict[str, Any], type[Exception]]] = [
    ({"maxForce": nan}, p.error),
    ({"maxForce": "strong"}, TypeError),
    ({"gearRatio": inf}, p.error),
    ({"erp": None}, TypeError),
    ({"relativePositionTarget": nan}, p.error),
    ({"jointChildPivot": [0.0, nan, 1.0]}, p.error),
    ({"jointChildFrameOrientation": [0.0, 0.0, 0.0, 0.0]}, p.error),
]


@pytest.mark.usefixtures("balls")
@pytest.mark.parametrize(("wrong", "kind"), CHANGES)
def test_a_change_that_cannot_be(wrong: dict[str, Any], kind: type[Exception]) -> None:
    constraint = make()
    before = p.getConstraintInfo(constraint)
    with pytest.raises(kind):
        p.changeConstraint(constraint, **wrong)
    assert p.getConstraintInfo(constraint) == before


def test_the_auxiliary_link_of_a_gear_is_reported_as_0_when_there_is_none(client: int) -> None:
    """As in PyBullet, though there it is not the motion of joint 0 that counts."""
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    arms = [
        p.createMultiBody(
            0,
            basePosition=[side, 0, 0],
            linkMasses=[1.0] * 2,
            linkCollisionShapeIndices=[ball] * 2,
            linkVisualShapeIndices=[-1] * 2,
            linkPositions=[[0, 0, 0.5]] * 2,
            linkOrientations=[[0, 0, 0, 1]] * 2,
            linkInertialFramePositions=[[0, 0, 0]] * 2,
            linkInertialFrameOrientations=[[0, 0, 0, 1]] * 2,
            linkParentIndices=[0, 1],
            linkJointTypes=[p.JOINT_REVOLUTE] * 2,
            linkJointAxis=[[0, 0, 1]] * 2,
        )
        for side in (0, 3)
    ]
    for arm in arms:
        p.setJointMotorControlArray(arm, [0, 1], p.VELOCITY_CONTROL, forces=[0, 0])
    gear = p.createConstraint(arms[0], 1, arms[1], 1, p.JOINT_GEAR, [0, 0, 1], [0, 0, 0], [0, 0, 0])
    p.changeConstraint(gear, gearRatio=-2, maxForce=1000)
    assert p.getConstraintInfo(gear)[12] == 0
    p.resetJointState(arms[0], 0, 0, 1.0)
    p.resetJointState(arms[0], 1, 0, 2.0)
    p.stepSimulation()
    driver, driven = p.getJointState(arms[0], 1)[1], p.getJointState(arms[1], 1)[1]
    assert driver == pytest.approx(2 * driven, abs=1e-9)
    p.changeConstraint(gear, gearAuxLink=1)
    assert p.getConstraintInfo(gear)[12] == 1


def test_a_gear_corrects_its_error_less_the_position_of_the_auxiliary_joint(client: int) -> None:
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    arm = p.createMultiBody(
        0,
        linkMasses=[1.0] * 3,
        linkCollisionShapeIndices=[ball] * 3,
        linkVisualShapeIndices=[-1] * 3,
        linkPositions=[[0, 0, 0.5]] * 3,
        linkOrientations=[[0, 0, 0, 1]] * 3,
        linkInertialFramePositions=[[0, 0, 0]] * 3,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * 3,
        linkParentIndices=[0] * 3,
        linkJointTypes=[p.JOINT_REVOLUTE] * 3,
        linkJointAxis=[[0, 0, 1]] * 3,
    )
    p.setJointMotorControlArray(arm, range(3), p.VELOCITY_CONTROL, forces=[0, 0, 0])
    gear = p.createConstraint(arm, 0, arm, 1, p.JOINT_GEAR, [0, 0, 1], [0, 0, 0], [0, 0, 0])
    p.changeConstraint(gear, gearRatio=1, gearAuxLink=2, relativePositionTarget=0.1, erp=0.1, maxForce=1000)
    p.resetJointState(arm, 0, 0.2)
    p.resetJointState(arm, 2, 0.3)
    p.setJointMotorControl2(arm, 2, p.POSITION_CONTROL, 0.3, force=1000)
    for _ in range(240):
        p.stepSimulation()
    # PyBullet's positions: 0.2 + 0 - 0.3 has become nearly 0.1.
    assert [p.getJointState(arm, joint)[0] for joint in range(3)] == pytest.approx(
        [0.299216, 0.099216, 0.3], abs=1e-6
    )


@pytest.mark.usefixtures("balls")
def test_a_still_link_of_a_base_that_was_freed_pulls_its_own_body() -> None:
    p.resetSimulation()
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2] * 3)
    # PyBullet takes the link for still for good, as the base could not move when it was made.
    freed = p.createMultiBody(
        0,
        box,
        linkMasses=[1.0],
        linkCollisionShapeIndices=[-1],
        linkVisualShapeIndices=[-1],
        linkPositions=[ORIGIN],
        linkOrientations=[TURN],
        linkInertialFramePositions=[ORIGIN],
        linkInertialFrameOrientations=[TURN],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_FIXED],
        linkJointAxis=[[0, 0, 1]],
    )
    tied = p.createMultiBody(0.5, box, basePosition=[-0.4, -0.2, 1.0])
    p.changeDynamics(freed, -1, mass=1)
    ends = [0.2, 0.2, 0.0], [-0.1, 0.4, -0.2]
    p.createConstraint(freed, 0, tied, -1, p.JOINT_POINT2POINT, ORIGIN, *ends)
    p.stepSimulation()
    velocity, spin = p.getBaseVelocity(freed)
    assert velocity == pytest.approx((-0.7171462471670235, -0.845175394043333, 1.2709721418410376), abs=1e-9)
    assert spin == pytest.approx((19.06458212761556, -19.06458212761556, -1.9204372031446428), abs=1e-9)
    assert p.getBaseVelocity(tied)[0] == pytest.approx(
        (2.868584988668094, 3.380701576173332, -5.08388856736415), abs=1e-9
    )
