"""Reading and setting the state of joints, links and bases."""

from math import pi

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import clients

NO_WRENCH = (0.0,) * 6


def test_joint_states_have_the_layout_of_pybullet(zoo: int) -> None:
    p.resetJointState(zoo, 0, 0.3, 0.5)
    assert p.getJointState(zoo, 0) == (0.3, 0.5, NO_WRENCH, 0.0)
    assert p.getJointState(zoo, 2) == (0.0, 0.0, NO_WRENCH, 0.0)
    assert p.getJointStates(zoo, [2, 0]) == (p.getJointState(zoo, 2), p.getJointState(zoo, 0))
    assert p.getJointStateMultiDof(zoo, 0) == ((0.3,), (0.5,), NO_WRENCH, (0.0,))
    assert p.getJointStateMultiDof(zoo, 2) == ((), (), NO_WRENCH, ())
    assert p.getJointStateMultiDof(zoo, 3) == ((0.0, 0.0, 0.0, 1.0), (0.0,) * 3, NO_WRENCH, (0.0,) * 3)
    assert p.getJointStatesMultiDof(zoo, [3]) == (p.getJointStateMultiDof(zoo, 3),)


@pytest.mark.parametrize("indices", [[0, 1], (0, 1), range(2), np.array([0, 1]), {0, 1}, [0.0, 1.0]])
def test_any_sequence_of_indices_will_do(zoo: int, indices: list[int]) -> None:
    expected = (p.getJointState(zoo, 0), p.getJointState(zoo, 1))
    assert p.getJointStates(zoo, indices) == expected
    assert p.getLinkStates(zoo, indices) == (p.getLinkState(zoo, 0), p.getLinkState(zoo, 1))
    assert len(p.getJointStatesMultiDof(zoo, indices) or ()) == 2


def test_numpy_integers_are_indices(zoo: int) -> None:
    assert p.getJointState(np.int64(zoo), np.int32(1)) == p.getJointState(zoo, 1)  # pyright: ignore


def test_no_joints_have_no_states(zoo: int) -> None:
    assert p.getJointStates(zoo, []) is None
    assert p.getJointStates(99, []) is None
    assert p.getJointStatesMultiDof(zoo, []) is None
    assert p.getLinkStates(zoo, []) == ()


def test_joint_info_is_that_of_the_file(zoo: int) -> None:
    info = p.getJointInfo(zoo, 0)
    assert info[:13] == (0, b"shoulder", p.JOINT_REVOLUTE, 7, 6, 1, 0.1, 0.02, -1.0, 1.5, 30.0, 4.0, b"arm")
    assert info[16] == -1
    assert [p.getJointInfo(zoo, joint)[2] for joint in range(5)] == [0, 1, 4, 2, 0]
    assert [p.getJointInfo(zoo, joint)[3] for joint in range(5)] == [7, 8, -1, 9, 13]
    assert [p.getJointInfo(zoo, joint)[4] for joint in range(5)] == [6, 7, -1, 8, 11]
    assert [p.getJointInfo(zoo, joint)[5] for joint in range(5)] == [1, 1, 0, 0, 1]
    assert p.getJointInfo(zoo, 4)[8:10] == (0.0, -1.0)
    assert p.getJointInfo(zoo, 3)[13] == (0.0, 0.0, 0.0)
    assert p.getJointInfo(zoo, 1)[16] == 0


def test_dofs_are_counted_until_a_joint_has_many(zoo: int, arm: int) -> None:
    assert p.computeDofCount(arm) == 3
    assert p.computeDofCount(zoo) == -1
    assert p.getNumJoints(zoo) == 5


def test_resets_of_joints_with_many_freedoms(zoo: int) -> None:
    turn = (0.0, 0.6, 0.0, 0.8)
    p.resetJointStateMultiDof(zoo, 3, turn, [1, 2, 3])
    assert p.getJointStateMultiDof(zoo, 3)[:2] == (turn, (1.0, 2.0, 3.0))
    p.resetJointStateMultiDof(zoo, 3, [0, 0, 0, 2])
    assert p.getJointStateMultiDof(zoo, 3)[:2] == ((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
    p.resetJointStatesMultiDof(zoo, [3, 0], [turn, [0.2]], [[1, 1, 1], [0.4]])
    assert p.getJointStateMultiDof(zoo, 3)[:2] == (turn, (1.0, 1.0, 1.0))
    assert p.getJointState(zoo, 0)[:2] == (0.2, 0.4)


def test_resets_that_do_not_fit_are_ignored(zoo: int) -> None:
    p.resetJointStateMultiDof(zoo, 3, [0, 0.6, 0, 0.8], [1, 2, 3])
    before = p.getJointStateMultiDof(zoo, 3)
    p.resetJointStateMultiDof(zoo, 3, [0, 0, 0], [5, 5, 5])
    p.resetJointStateMultiDof(zoo, 3, [], [5, 5, 5])
    p.resetJointState(zoo, 3, 0.5)
    p.resetJointState(zoo, 2, 0.5)
    assert p.getJointStateMultiDof(zoo, 3) == before


def test_one_wrong_reset_of_many_moves_nothing(zoo: int) -> None:
    with pytest.raises(p.error, match=r"^Joint index out-of-range\."):
        p.resetJointStatesMultiDof(zoo, [0, 9], [[0.5], [0.5]])
    with pytest.raises(p.error, match=r"^Number of targetValues and targetVelocities needs to match"):
        p.resetJointStatesMultiDof(zoo, [0, 1], [[0.5]])
    p.resetJointStatesMultiDof(zoo, [], [[0.5]])
    assert p.getJointState(zoo, 0)[0] == 0.0


def test_motor_torques_are_impulses_by_time(arm: int) -> None:
    p.setGravity(0, 0, -9.8)
    p.resetJointState(arm, 0, 0.5)
    p.stepSimulation()
    holding = p.getJointState(arm, 0)[3]
    assert abs(holding) > 1.0
    p.setTimeStep(2 / 240)
    assert p.getJointState(arm, 0)[3] == pytest.approx(holding / 2)


def test_link_frames_and_centres_of_mass(floating_arm: int) -> None:
    state = p.getLinkState(floating_arm, 1)
    assert state is not None
    com, turn, offset, offset_turn, origin, origin_turn = state[:6]
    assert offset == (0.0, 0.0, 0.15)
    assert origin == pytest.approx((0.1, 0.2, 0.3 + 0.05 + 0.4))
    placed = p.multiplyTransforms(origin, origin_turn, offset, offset_turn)
    assert placed[0] == pytest.approx(com)
    assert placed[1] == pytest.approx(turn)


def test_link_states_follow_resets(arm: int) -> None:
    before = p.getLinkState(arm, 2)
    p.resetJointState(arm, 0, 0.4)
    after = p.getLinkState(arm, 2)
    assert before is not None
    assert after is not None
    assert after[0] != before[0]


def test_link_velocities_are_those_of_rigid_bodies(floating_arm: int) -> None:
    p.resetBaseVelocity(floating_arm, [1, 2, 3], [0.1, 0.2, 0.3])
    state = p.getLinkState(floating_arm, 1, computeLinkVelocity=1)
    assert state is not None
    assert len(state) == 8
    from_base = np.array(state[0]) - p.getBasePositionAndOrientation(floating_arm)[0]
    assert state[7] == pytest.approx((0.1, 0.2, 0.3))
    assert np.array(state[6]) == pytest.approx(np.add(np.cross([0.1, 0.2, 0.3], from_base), [1, 2, 3]))


def test_poses_of_links_are_those_before_the_last_step_until_they_are_asked_anew(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, targetVelocity=1)
    p.stepSimulation()
    p.stepSimulation()
    old, new = p.getLinkState(arm, 0), p.getLinkState(arm, 0, computeForwardKinematics=1)
    assert old is not None
    assert new is not None
    angle = p.getJointState(arm, 0)[0]
    assert p.getEulerFromQuaternion(new[1])[1] == pytest.approx(angle)
    assert p.getEulerFromQuaternion(old[1])[1] == pytest.approx(angle / 2)


def test_links_that_do_not_exist(arm: int) -> None:
    assert p.getLinkState(arm, 9) is None
    assert p.getLinkStates(arm, [0, 9, -1]) == (p.getLinkState(arm, 0), None, None)


def test_bases_can_be_moved_and_are_stopped(floating_arm: int) -> None:
    p.resetBaseVelocity(floating_arm, [1, 2, 3], [4, 5, 6])
    assert p.getBaseVelocity(floating_arm) == ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0))
    p.resetBaseVelocity(floating_arm, angularVelocity=(7, 8, 9))
    assert p.getBaseVelocity(floating_arm) == ((1.0, 2.0, 3.0), (7.0, 8.0, 9.0))
    p.resetBaseVelocity(floating_arm, linearVelocity=np.zeros(3))
    assert p.getBaseVelocity(floating_arm) == ((0.0, 0.0, 0.0), (7.0, 8.0, 9.0))
    p.resetBasePositionAndOrientation(floating_arm, [1, 2, 3], np.array([0, 0, 2, 0]))
    assert p.getBasePositionAndOrientation(floating_arm) == ((1.0, 2.0, 3.0), (0.0, 0.0, 1.0, 0.0))
    assert p.getBaseVelocity(floating_arm) == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize("sign", [1, -1])
def test_orientations_have_the_sign_of_a_matrix(floating_arm: int, sign: int) -> None:
    for turn in ([0.5, 0.1, 0.1, 0.85], [0.1, 0.9, 0.1, 0.3]):
        unit = np.array(turn) / np.linalg.norm(turn)
        p.resetBasePositionAndOrientation(floating_arm, [0, 0, 0], sign * unit)
        assert p.getBasePositionAndOrientation(floating_arm)[1] == pytest.approx(tuple(unit))


def test_forces_act_at_points_and_for_one_step(floating_arm: int) -> None:
    p.changeDynamics(floating_arm, -1, linearDamping=0, angularDamping=0)
    mass = sum(p.getDynamicsInfo(floating_arm, link)[0] for link in range(-1, 3))
    p.applyExternalForce(
        floating_arm, -1, [0, 0, mass], p.getBasePositionAndOrientation(floating_arm)[0], p.WORLD_FRAME
    )
    p.applyExternalForce(floating_arm, -1, [0, 0, mass], [0, 0, 0], p.LINK_FRAME)
    p.stepSimulation()
    velocity = p.getBaseVelocity(floating_arm)[0][2]
    assert velocity == pytest.approx(2 / 240, rel=0.01)
    p.stepSimulation()
    assert p.getBaseVelocity(floating_arm)[0][2] == pytest.approx(velocity, rel=0.01)


@pytest.mark.insides
def test_a_force_beside_the_centre_is_a_force_and_a_torque(floating_arm: int) -> None:
    world = clients[0].world
    row = world.bodies[floating_arm].first_link
    p.resetBasePositionAndOrientation(floating_arm, [1, 0, 0], p.getQuaternionFromEuler([0, 0, pi / 2]))
    p.applyExternalForce(floating_arm, -1, [0, 0, 2], [1, 3, 0], p.WORLD_FRAME)
    assert world.link_force[row] == pytest.approx([0, 0, 2, 6, 0, 0])
    p.applyExternalForce(floating_arm, -1, [1, 0, 0], [0, 1, 0], p.LINK_FRAME)
    assert world.link_force[row] == pytest.approx([0, 1, 2, 6, 0, -1])
    p.applyExternalTorque(floating_arm, -1, [0, 5, 0], p.LINK_FRAME)
    p.applyExternalTorque(floating_arm, -1, [0, 5, 0], p.WORLD_FRAME)
    assert world.link_force[row] == pytest.approx([0, 1, 2, 1, 5, -1])


def test_sensors_measure_what_the_joint_carries(zoo: int) -> None:
    p.setGravity(0, 0, -10)
    p.enableJointForceTorqueSensor(zoo, 2)
    p.enableJointForceTorqueSensor(zoo, 2, 1)
    p.setJointMotorControl2(zoo, 0, p.VELOCITY_CONTROL, force=1000)
    for _ in range(240):
        p.stepSimulation()
    # As PyBullet 3.2.7 measures it.
    force = (-4.458357843567, -0.000891371974, 7.164814562268)
    torque = (0.716486773549, -0.028534174950, 0.262423595229)
    assert p.getJointState(zoo, 2)[2] == pytest.approx((*force, *torque), abs=1e-6)
    assert p.getJointState(zoo, 0)[2] == NO_WRENCH
    p.enableJointForceTorqueSensor(zoo, 2, 0)
    assert p.getJointState(zoo, 2)[2] == NO_WRENCH


def test_mass_matrix_and_inverse_dynamics_belong_together(arm: int) -> None:
    q, qd, qdd = [0.3, -0.4, 0.05], [0.1, 0.2, 0.3], [1.0, -2.0, 0.5]
    matrix = np.array(p.calculateMassMatrix(arm, q))
    still = np.array(p.calculateInverseDynamics(arm, q, qd, [0, 0, 0]))
    moved = np.array(
        p.calculateInverseDynamics(bodyIndex=arm, objPositions=q, objVelocities=qd, objAccelerations=qdd)
    )
    assert moved - still == pytest.approx(matrix @ qdd)
    assert matrix == pytest.approx(matrix.T)
    assert np.array(p.calculateMassMatrix(arm, np.array([*q, 9, 9]))) == pytest.approx(matrix)


def test_masses_changed_while_running_count_at_once(arm: int) -> None:
    q, still = [0.3, -0.4, 0.05], [0.0] * 3
    p.setGravity(0, 0, -9.81)

    def answers() -> list[np.ndarray]:
        forces = p.calculateInverseDynamics(arm, q, still, still)
        return [np.array(p.calculateMassMatrix(arm, q)), np.array(forces)]

    before, links = answers(), p.getLinkStates(arm, [0, 1, 2])
    for link in range(-1, p.getNumJoints(arm)):
        info = p.getDynamicsInfo(arm, link)
        p.changeDynamics(arm, link, mass=2 * info[0], localInertiaDiagonal=[2 * moment for moment in info[2]])
    for new, old in zip(answers(), before, strict=True):
        assert new == pytest.approx(2 * old)
    assert p.getLinkStates(arm, [0, 1, 2]) == links


def test_jacobians_are_derivatives(arm: int) -> None:
    point, q = [0.1, 0.0, 0.2], np.array([0.3, -0.4, 0.05])
    linear, _ = p.calculateJacobian(arm, 1, point, q, np.zeros(3), np.zeros(3))

    def place(positions: np.ndarray) -> np.ndarray:
        for joint, position in enumerate(positions):
            p.resetJointState(arm, joint, position)
        state = p.getLinkState(arm, 1)
        assert state is not None
        # The point is given from the origin of the link frame, in the axes of the inertial frame.
        return np.array(state[4]) + p.rotateVector(state[1], point)

    step = 1e-6
    numeric = [(place(q + step * axis) - place(q - step * axis)) / (2 * step) for axis in np.eye(3)]
    assert np.array(linear) == pytest.approx(np.array(numeric).T, abs=1e-8)
