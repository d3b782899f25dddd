"""What motor calls set; what the settings then do is compared with PyBullet by the conformance suite."""

from collections.abc import Callable, Sequence
from functools import partial
from math import inf, nan
from typing import Any

import numpy as np
import pytest
from tests.rings import few

import pybullet as p
from carom import Worlds
from pybullet._clients.clients import clients

POSITION, VELOCITY, KP, KD, IMPULSE, CLAMP, DAMPING, TARGET_W = range(8)
TIME_STEP = 1 / 240


def motor(body: int, joint: int, axis: int = 0) -> np.ndarray:
    handle = clients[0].world.bodies[body]
    return handle.world.motor[handle.velocity_index[joint] + axis].copy()


def drive(body: int, joint: int) -> np.ndarray:
    handle = clients[0].world.bodies[body]
    return handle.world.pd[handle.velocity_index[joint], :5].copy()


def torque(body: int, joint: int) -> list[float]:
    handle = clients[0].world.bodies[body]
    first = handle.velocity_index[joint]
    return handle.world.joint_torque[first : first + handle.velocity_count[joint]].tolist()


class BareSequence:
    """A sequence that is no more than that."""

    def __init__(self, values: list[float]) -> None:
        self._values = values

    def __len__(self) -> int:
        return len(self._values)

    def __getitem__(self, place: int) -> float:
        return self._values[place]


def test_position_control(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, 0.3, 0.1, 20, 0.5, 0.8)
    assert motor(arm, 0)[:6].tolist() == [0.3, 0.1, 0.5, 0.8, 20 * TIME_STEP, inf]


def rows_after(arm: int, calls: Sequence[Callable[[], object]]) -> list[list[float]]:
    """What each call makes of a motor's row in which all was -1."""
    rows = []
    for call in calls:
        body = clients[0].world.bodies[arm]
        body.world.motor[body.velocity_index[0], :6] = -1.0
        call()
        rows.append(motor(arm, 0)[:6].tolist())
    return rows


@pytest.mark.parametrize(("target", "reached"), [(0.3, 0.3), (9.0, 2.0)])
def test_position_control_means_the_same_in_every_call(arm: int, target: float, reached: float) -> None:
    body = clients[0].world.bodies[arm]
    single = partial(p.setJointMotorControl2, arm, 0, p.POSITION_CONTROL)
    multi = partial(p.setJointMotorControlMultiDof, arm, 0, p.POSITION_CONTROL)
    several = partial(p.setJointMotorControlArray, arm, [0], p.POSITION_CONTROL)
    multi_array = partial(p.setJointMotorControlMultiDofArray, arm, [0], p.POSITION_CONTROL)
    gains = {"gain": 0.5, "velocity": 0.1, "velocity_gain": 0.8, "max_force": 20.0, "max_velocity": 3.0}
    expected = [reached, 0.1, 0.5, 0.8, 20.0 * TIME_STEP]
    with_velocity = [
        partial(single, target, 0.1, 20.0, 0.5, 0.8, maxVelocity=3.0),
        partial(
            multi, [target], [0.1], force=[20.0], positionGain=[0.5], velocityGain=[0.8], maxVelocity=3.0
        ),
        partial(body.joints[0].set_position_target, target, **gains),
    ]
    assert rows_after(arm, with_velocity) == [[*expected, 3.0]] * 3
    # Lists of joints have no greatest velocity; that from before stays.
    lists = [
        partial(several, [target], [0.1], [20.0], [0.5], [0.8]),
        partial(multi_array, [[target]], [[0.1]], [[20.0]], [0.5], [0.8]),
    ]
    assert rows_after(arm, lists) == [[*expected, -1.0]] * 2
    worlds = Worlds(body.world, 2)
    worlds[body].joints[[0]].set_position_targets(
        [target], gains=0.5, velocities=0.1, velocity_gains=0.8, max_forces=20.0, max_velocities=3.0
    )
    copy = worlds.extract(1)
    assert copy.motor[body.velocity_index[0], :6].tolist() == [*expected, 3.0]


def test_velocity_control_means_the_same_in_every_call(arm: int) -> None:
    joint = clients[0].world.bodies[arm].joints[0]
    single = partial(p.setJointMotorControl2, arm, 0, p.VELOCITY_CONTROL)
    several = partial(p.setJointMotorControlArray, arm, [0], p.VELOCITY_CONTROL)
    calls = [
        partial(single, 9.0, 0.2, 5.0, positionGain=0.4, velocityGain=0.7),
        partial(several, [9.0], [0.2], [5.0], [0.4], [0.7]),
        partial(joint.set_velocity_target, 0.2, gain=0.7, max_force=5.0),
    ]
    assert rows_after(arm, calls) == [[0.0, 0.2, 0.0, 0.7, 5.0 * TIME_STEP, inf]] * 3


def test_targets_are_taken_to_the_limits(arm: int) -> None:
    for target, reached in ((9.0, 2.0), (-9.0, -2.0), (1.5, 1.5)):
        p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, target)
        assert motor(arm, 0)[POSITION] == reached
    p.changeDynamics(arm, 0, jointLowerLimit=-0.5, jointUpperLimit=0.5)
    p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, 9.0)
    assert motor(arm, 0)[POSITION] == 0.5


def test_joints_without_limits_take_any_target(zoo: int) -> None:
    p.setJointMotorControl2(zoo, 4, p.POSITION_CONTROL, 123.0)
    assert motor(zoo, 4)[POSITION] == 123.0


def test_a_velocity_bound_stays_until_velocity_control(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, 0.3, maxVelocity=1.5)
    p.setJointMotorControl2(arm, 0, p.POSITION_CONTROL, 0.3)
    assert motor(arm, 0)[CLAMP] == 1.5
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL)
    assert motor(arm, 0)[CLAMP] == inf


def test_velocity_control(arm: int) -> None:
    p.setJointMotorControl2(arm, 1, p.POSITION_CONTROL, 0.3)
    p.setJointMotorControl2(arm, 1, p.VELOCITY_CONTROL, targetVelocity=2, force=10, velocityGain=0.5)
    assert motor(arm, 1)[:5].tolist() == [0.0, 2.0, 0.0, 0.5, 10 * TIME_STEP]


def test_impulses_keep_the_time_step_they_were_set_with(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=10)
    p.setTimeStep(0.01)
    assert motor(arm, 0)[IMPULSE] == 10 * TIME_STEP
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=10)
    assert motor(arm, 0)[IMPULSE] == 0.1


def test_torques_add_up_for_one_step(arm: int) -> None:
    before = motor(arm, 0)
    p.setJointMotorControl2(arm, 0, p.TORQUE_CONTROL, force=2)
    p.setJointMotorControl2(arm, 0, p.TORQUE_CONTROL, force=float(np.float32(0.5)))
    assert torque(arm, 0) == [2.5]
    assert (motor(arm, 0) == before).all()
    p.stepSimulation()
    assert torque(arm, 0) == [0.0]


def test_pd_control_comes_and_goes(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.PD_CONTROL, 9.0, 0.1, 30, 50, 5)
    assert drive(arm, 0).tolist() == [2.0, 0.1, 50.0, 5.0, 30.0]
    p.setJointMotorControl2(arm, 0, p.PD_CONTROL, force=0)
    assert drive(arm, 0)[4] == 0.0


@pytest.mark.parametrize("mode", [p.VELOCITY_CONTROL, p.TORQUE_CONTROL, p.POSITION_CONTROL, p.PD_CONTROL])
def test_fixed_joints_ignore_their_motor(zoo: int, mode: int) -> None:
    before = clients[0].world.motor.copy()
    p.setJointMotorControl2(zoo, 2, mode, 1, 1, 1)
    p.setJointMotorControlArray(zoo, [2], mode, [1])
    p.setJointMotorControlMultiDof(zoo, 2, p.POSITION_CONTROL, [1])
    p.setJointMotorControlMultiDof(zoo, 2, p.TORQUE_CONTROL, force=[1])
    assert (clients[0].world.motor == before).all()
    assert not clients[0].world.joint_torque.any()


@pytest.mark.parametrize("convert", [list, tuple, np.array, np.float32, BareSequence])
def test_arrays_set_each_joint(arm: int, convert: Any) -> None:
    values = convert([0.25, 0.125, 0.0625])
    p.setJointMotorControlArray(arm, range(3), p.POSITION_CONTROL, values, values, values, values, values)
    for joint, value in enumerate((0.25, 0.125, 0.0625)):
        assert motor(arm, joint)[:5].tolist() == [value, value, value, value, value * TIME_STEP]


def test_arrays_have_the_defaults_of_single_calls(arm: int) -> None:
    for mode in (p.POSITION_CONTROL, p.VELOCITY_CONTROL):
        p.setJointMotorControl2(arm, 0, mode)
        p.setJointMotorControlArray(arm, [1], mode)
        assert (motor(arm, 0) == motor(arm, 1)).all()


def test_arrays_of_torques(arm: int) -> None:
    p.setJointMotorControlArray(arm, np.array([2, 0]), p.TORQUE_CONTROL, forces=[3, 4])
    assert torque(arm, 2) == [3.0]
    assert torque(arm, 0) == [4.0]
    p.setJointMotorControlArray(bodyIndex=arm, jointIndices=(), controlMode=p.TORQUE_CONTROL)


def test_an_array_with_one_wrong_joint_sets_none(arm: int) -> None:
    before = clients[0].world.motor.copy()
    with pytest.raises(p.error, match=r"^Joint index out-of-range\."):
        p.setJointMotorControlArray(arm, [0, 1, 9], p.POSITION_CONTROL, [0.1, 0.2, 0.3])
    assert (clients[0].world.motor == before).all()


def test_the_old_call_in_all_its_forms(arm: int) -> None:
    p.setJointMotorControl(arm, 0, p.POSITION_CONTROL, 0.3)
    assert motor(arm, 0)[:5].tolist() == [0.3, 0.0, 0.1, 1.0, 100000 * TIME_STEP]
    p.setJointMotorControl(arm, 0, p.VELOCITY_CONTROL, 2, 10)
    assert motor(arm, 0)[:5].tolist() == [0.0, 2.0, 0.0, 1.0, 10 * TIME_STEP]
    p.setJointMotorControl(arm, 0, p.VELOCITY_CONTROL, 2, 10, 0.7)
    assert motor(arm, 0)[KD] == 0.7
    p.setJointMotorControl(arm, 0, p.POSITION_CONTROL, 0.4, 10, 0.7)
    assert motor(arm, 0)[:4].tolist() == [0.4, 0.0, 0.7, 1.0]
    p.setJointMotorControl(arm, 0, p.TORQUE_CONTROL, 6)
    p.setJointMotorControl(arm, 0, p.TORQUE_CONTROL, 0, 0, 99, 0, 0)
    assert torque(arm, 0) == [6.0]
    p.setJointMotorControl(arm, 0, p.POSITION_CONTROL, 0.5, 0.6, 12, 0.7, 0.8)
    assert motor(arm, 0)[:5].tolist() == [0.5, 0.6, 0.7, 0.8, 12 * TIME_STEP]


def test_a_ball_joint_takes_a_quaternion_and_gains_for_all_axes(zoo: int) -> None:
    target = p.getQuaternionFromEuler([0.1, 0.2, 0.3])
    p.setJointMotorControlMultiDof(
        zoo, 3, p.POSITION_CONTROL, target, [1, 2, 3], [9], positionGain=0.5, velocityGain=0.7, damping=0.2
    )
    for axis in range(3):
        row = [target[axis], axis + 1, 0.5, 0.7, 9 * TIME_STEP, inf, 0.2]
        assert motor(zoo, 3, axis)[:7].tolist() == pytest.approx(row)
    assert motor(zoo, 3)[TARGET_W] == target[3]


def test_joints_are_named_by_integers_of_any_kind(zoo: int) -> None:
    unusual: list[Any] = [np.int64(1), np.uint8(1), np.array(1)]
    for index in unusual:
        assert p.getJointState(zoo, index) == p.getJointState(zoo, 1)
        assert p.getJointStateMultiDof(zoo, index) == p.getJointStateMultiDof(zoo, 1)
        assert p.getJointInfo(zoo, index) == p.getJointInfo(zoo, 1)
    with pytest.raises(p.error, match="99"):
        p.getJointState(zoo, unusual[0] * 99)


@pytest.mark.parametrize("kind", [np.float32, np.int64, np.array])
def test_gains_are_numbers_of_any_kind(zoo: int, kind: type[Any]) -> None:
    p.setJointMotorControlMultiDof(
        zoo, 3, p.POSITION_CONTROL, [0, 0, 0, 1], force=[9], positionGain=kind(1), velocityGain=kind(2)
    )
    assert [motor(zoo, 3, axis)[2:4].tolist() for axis in range(3)] == [[1.0, 2.0]] * 3


def test_a_ball_joint_takes_gains_by_axis_when_all_are(zoo: int) -> None:
    by_axis = [1.0, 2.0, 3.0]
    p.setJointMotorControlMultiDof(
        zoo,
        3,
        p.POSITION_CONTROL,
        [0, 0, 0, 1],
        force=by_axis,
        positionGain=by_axis,
        velocityGain=by_axis,
        damping=by_axis,
    )
    for axis, value in enumerate(by_axis):
        row = motor(zoo, 3, axis)
        assert row[[KP, KD, IMPULSE, DAMPING]].tolist() == [value, value, value * TIME_STEP, value]
    p.setJointMotorControlMultiDof(
        zoo, 3, p.POSITION_CONTROL, [0, 0, 0, 1], force=by_axis, positionGain=by_axis, velocityGain=2
    )
    for axis in range(3):
        assert motor(zoo, 3, axis)[[KP, KD, IMPULSE]].tolist() == [1.0, 2.0, TIME_STEP]


def test_lists_that_do_not_fit_count_as_not_given(zoo: int) -> None:
    p.setJointMotorControlMultiDof(
        zoo, 3, p.POSITION_CONTROL, [0, 0, 0, 1], force=[1, 2], positionGain=[1, 2], velocityGain=[1, 2]
    )
    assert motor(zoo, 3)[[KP, KD, IMPULSE]].tolist() == [0.1, 0.0, pytest.approx(1000000 * TIME_STEP)]
    before = motor(zoo, 3)
    p.setJointMotorControlMultiDof(zoo, 3, p.POSITION_CONTROL, [0, 0, 1], positionGain=5)
    assert (motor(zoo, 3) == before).all()
    p.setJointMotorControlMultiDof(zoo, 3, p.TORQUE_CONTROL, force=[1])
    assert torque(zoo, 3) == [0.0, 0.0, 0.0]


def test_torques_of_a_ball_joint(zoo: int) -> None:
    p.setJointMotorControlMultiDof(zoo, 3, p.TORQUE_CONTROL, force=[1, 2, 3])
    p.setJointMotorControlMultiDofArray(zoo, [3, 0], p.TORQUE_CONTROL, forces=[[1, 1, 1], [5]])
    assert torque(zoo, 3) == [2.0, 3.0, 4.0]
    assert torque(zoo, 0) == [5.0]


@pytest.mark.parametrize("bad", few([nan, inf, 1e31, -1e31, 10**40, "1", None], 3))
@pytest.mark.parametrize("among", few([0.5, 2, -1e31, inf], 2))
@pytest.mark.parametrize(
    "argument", ["targetPositions", "targetVelocities", "positionGains", "velocityGains"]
)
@pytest.mark.parametrize("mode", [p.POSITION_CONTROL, p.STABLE_PD_CONTROL])
def test_no_number_of_a_list_hides_behind_others(
    zoo: int, mode: int, argument: str, among: float, bad: Any
) -> None:
    values: Any = [among, bad] if argument.endswith("Gains") else [[among], [bad]]
    given: dict[str, Any] = {argument: values}
    before = motor(zoo, 0).copy()
    with pytest.raises((p.error, TypeError)):
        p.setJointMotorControlMultiDofArray(zoo, [0, 1], mode, **given)
    assert (motor(zoo, 0) == before).all()


@pytest.mark.parametrize("joints", [[0, 99], [-1, 0], [99, 0]])
def test_joints_that_are_not_there_are_refused_by_arrays(zoo: int, joints: list[int]) -> None:
    with pytest.raises(p.error, match="out-of-range"):
        p.setJointMotorControlMultiDofArray(zoo, joints, p.TORQUE_CONTROL, forces=[[1], [1]])


def test_lists_of_one_for_joints_of_one_freedom(zoo: int) -> None:
    p.setJointMotorControlMultiDof(
        zoo, 0, p.POSITION_CONTROL, [9], [2], [3], positionGain=0.4, velocityGain=[0.6], maxVelocity=2
    )
    assert motor(zoo, 0)[:6].tolist() == [1.5, 2.0, 0.4, 0.6, 3 * TIME_STEP, 2.0]
    p.setJointMotorControlMultiDofArray(zoo, (0,), p.PD_CONTROL, [[0.5]], [[1]], [[7]], [20], [2])
    assert drive(zoo, 0).tolist() == [0.5, 1.0, 20.0, 2.0, 7.0]


def test_arrays_of_lists_do_nothing_when_their_numbers_differ(zoo: int) -> None:
    before = clients[0].world.motor.copy()
    p.setJointMotorControlMultiDofArray(zoo, [0, 1], p.POSITION_CONTROL, [[0.1]])
    p.setJointMotorControlMultiDofArray(zoo, [], p.POSITION_CONTROL, [])
    assert (clients[0].world.motor == before).all()


def test_ball_joints_in_single_calls(zoo: int) -> None:
    p.setJointMotorControl2(zoo, 3, p.POSITION_CONTROL, targetPosition=0, force=0, positionGain=0)
    assert [motor(zoo, 3, axis)[IMPULSE] for axis in range(3)] == [0.0, 0.0, 0.0]
    assert motor(zoo, 3)[TARGET_W] == 1.0
    p.setJointMotorControl2(zoo, 3, p.TORQUE_CONTROL, force=4)
    assert torque(zoo, 3) == [4.0, 0.0, 0.0]


@pytest.mark.parametrize("floating", [False, True])
def test_stable_pd_holds_joints_that_stiff_pd_would_throw_about(
    arm_path: str, client: int, floating: bool
) -> None:
    body = p.loadURDF(arm_path, useFixedBase=not floating, flags=p.URDF_USE_INERTIA_FROM_FILE)
    p.setTimeStep(1 / 60)
    joints = [0, 1, 2]
    p.setJointMotorControlArray(body, joints, p.VELOCITY_CONTROL, forces=[0, 0, 0])
    for _ in range(240):
        p.setJointMotorControlMultiDofArray(
            body,
            joints,
            p.STABLE_PD_CONTROL,
            targetPositions=[[0.4], [-0.3], [0.1]],
            targetVelocities=[[0]] * 3,
            forces=[[1000]] * 3,
            positionGains=[2000] * 3,
            velocityGains=[200] * 3,
        )
        p.stepSimulation()
    positions = [state[0] for state in p.getJointStates(body, joints) or ()]
    # A slider of a floating body moves along another axis in PyBullet's controller: it need not settle.
    assert positions[:2] == pytest.approx([0.4, -0.3], abs=0.01)
    if not floating:
        assert positions[2] == pytest.approx(0.1, abs=0.01)
