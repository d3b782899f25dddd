"""Motors of spherical joints, and the calls that command joints of any number of dofs."""

from __future__ import annotations

from typing import Any

from ..scenario import joint_motion, load, movable_joints, release_motors, scenario, simulate, under
from .free_motion import spherical_motion

BALLS = [0, 1, 2]


def _chain(p: Any, released: bool = True) -> int:
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    body = load(p, "spherical_chain.urdf", useFixedBase=True)
    if released:
        release_motors(p, body)
    for joint in BALLS:
        p.resetJointStateMultiDof(
            body, joint, p.getQuaternionFromEuler([0.2, -0.1 * joint, 0.3]), [0.3, 0.2, -0.4]
        )
    return body


def _move(p: Any, body: int, act: Any = None) -> dict[str, Any]:
    def observe() -> dict[str, Any]:
        torques = [state[3] for state in p.getJointStatesMultiDof(body, BALLS)]
        return spherical_motion(p, body, BALLS) | {"motor_torque": torques}

    return simulate(p, 2.0, observe, act, stride=16)


@scenario()
def spherical_position(p: Any) -> dict[str, Any]:
    """Spherical position motors over gains and force limits."""
    results: dict[str, Any] = {}
    for gain, damping, force in ((0.1, 1.0, 200.0), (0.5, 0.6, 200.0), (0.1, 1.0, 1.5), (0.03, 0.2, 8.0)):
        body = _chain(p)
        for joint in BALLS:
            p.setJointMotorControlMultiDof(
                body,
                joint,
                p.POSITION_CONTROL,
                targetPosition=p.getQuaternionFromEuler([-0.5, 0.4, 0.2 * joint]),
                targetVelocity=[0.0, 0.0, 0.0],
                positionGain=gain,
                velocityGain=damping,
                force=[force, force, force],
            )
        results |= under(f"kp {gain}, kd {damping}, {force} N m", _move(p, body))
    return results


@scenario()
def spherical_position_with_velocity(p: Any) -> dict[str, Any]:
    """Spherical motors with target velocities, unequal forces per axis, and a speed bound."""
    results: dict[str, Any] = {}
    body = _chain(p)
    p.setJointMotorControlMultiDof(
        body,
        0,
        p.POSITION_CONTROL,
        targetPosition=[0.0, 0.0, 0.0, 1.0],
        targetVelocity=[0.5, -0.3, 0.2],
        positionGain=0.0,
        velocityGain=0.9,
        force=[20.0, 5.0, 1.0],
    )
    results |= under("velocity", _move(p, body))
    body = _chain(p)
    p.setJointMotorControlMultiDof(
        body,
        0,
        p.POSITION_CONTROL,
        targetPosition=p.getQuaternionFromEuler([1.0, 0.5, 0.0]),
        force=[300.0, 300.0, 300.0],
        maxVelocity=0.6,
    )
    return results | under("speed bound", _move(p, body))


@scenario()
def spherical_gains_per_axis(p: Any) -> dict[str, Any]:
    """Gains and damping given as lists, one value per axis."""
    # Not released before: in PyBullet a list of gains does not wake a motor that a single gain switched off.
    body = _chain(p, released=False)
    p.setJointMotorControlMultiDof(
        body,
        0,
        p.POSITION_CONTROL,
        targetPosition=p.getQuaternionFromEuler([0.4, -0.3, 0.2]),
        targetVelocity=[0.0, 0.0, 0.0],
        force=[100.0, 100.0, 100.0],
        positionGain=[0.1, 0.05, 0.2],
        velocityGain=[1.0, 0.6, 0.8],
        damping=[1.0, 0.9, 0.7],
    )
    return _move(p, body)


@scenario()
def spherical_torque(p: Any) -> dict[str, Any]:
    """Torques on spherical joints, in the joint's own axes."""
    body = _chain(p)

    def push(step: int) -> None:
        if step < 240:
            for joint in BALLS:
                p.setJointMotorControlMultiDof(body, joint, p.TORQUE_CONTROL, force=[0.5, -0.3 * joint, 0.2])

    return _move(p, body, push)


@scenario()
def multi_dof_calls_on_revolute(p: Any) -> dict[str, Any]:
    """setJointMotorControlMultiDof on joints of one dof: position and torque."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "seven_dof.urdf", useFixedBase=True)
    joints = movable_joints(p, body)
    release_motors(p, body)
    for joint in joints[:4]:
        p.setJointMotorControlMultiDof(
            body, joint, p.POSITION_CONTROL, targetPosition=[0.3], targetVelocity=[0.1], force=[40.0]
        )

    def push(step: int) -> None:
        for joint in joints[4:]:
            p.setJointMotorControlMultiDof(body, joint, p.TORQUE_CONTROL, force=[0.3])

    return simulate(p, 2.0, lambda: joint_motion(p, body, joints), push)


@scenario()
def multi_dof_array_position(p: Any) -> dict[str, Any]:
    """setJointMotorControlMultiDofArray with position targets for spherical and revolute joints."""
    body = _chain(p, released=False)
    p.setJointMotorControlMultiDofArray(
        body,
        BALLS,
        p.POSITION_CONTROL,
        targetPositions=[list(p.getQuaternionFromEuler([0.3, 0.1 * joint, -0.2])) for joint in BALLS],
        targetVelocities=[[0.0, 0.0, 0.0]] * 3,
        forces=[[30.0, 30.0, 30.0]] * 3,
        positionGains=[0.1, 0.2, 0.3],
        velocityGains=[1.0, 0.9, 0.8],
    )
    results = under("spherical", _move(p, body))
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    arm = load(p, "seven_dof.urdf", useFixedBase=True)
    joints = movable_joints(p, arm)
    p.setJointMotorControlMultiDofArray(
        arm,
        joints,
        p.POSITION_CONTROL,
        targetPositions=[[0.3 - 0.1 * count] for count in range(7)],
        targetVelocities=[[0.0]] * 7,
        forces=[[60.0]] * 7,
        positionGains=[0.05] * 7,
        velocityGains=[0.9] * 7,
    )
    return results | under("revolute", simulate(p, 2.0, lambda: joint_motion(p, arm, joints), stride=16))


@scenario()
def multi_dof_array_torque(p: Any) -> dict[str, Any]:
    """setJointMotorControlMultiDofArray with torques."""
    body = _chain(p)

    def push(step: int) -> None:
        if step < 200:
            p.setJointMotorControlMultiDofArray(
                body, BALLS, p.TORQUE_CONTROL, forces=[[0.4, 0.1, 0.0], [0.0, 0.3, -0.1], [0.1, 0.0, 0.2]]
            )

    return _move(p, body, push)


def _stable_pd(p: Any, robot: str, gain: float, damping: float, force: float) -> dict[str, Any]:
    """Hold a floating robot's joints near zero by STABLE_PD_CONTROL.

    The base floats because PyBullet's own answer on fixed bases, and on bodies with nothing but
    spherical joints, depends on what earlier commands left in its memory.
    """
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    body = load(p, robot, basePosition=[0, 0, 9])
    release_motors(p, body)
    joints = movable_joints(p, body)
    spherical = [p.getJointInfo(body, joint)[2] == p.JOINT_SPHERICAL for joint in joints]
    turn = list(p.getQuaternionFromEuler([0.3, 0.1, -0.1]))

    def control(step: int) -> None:
        p.setJointMotorControlMultiDofArray(
            body,
            joints,
            p.STABLE_PD_CONTROL,
            targetPositions=[turn if ball else [0.05] for ball in spherical],
            targetVelocities=[[0.0, 0.0, 0.0] if ball else [0.1] for ball in spherical],
            forces=[[force, force, force] if ball else [force] for ball in spherical],
            positionGains=[gain] * len(joints),
            velocityGains=[damping] * len(joints),
        )

    def observe() -> dict[str, Any]:
        states = p.getJointStatesMultiDof(body, joints)
        return {"position": [state[0] for state in states], "velocity": [state[1] for state in states]}

    return simulate(p, 2.0, observe, control, stride=16)


@scenario()
def stable_pd_of_many_kinds(p: Any) -> dict[str, Any]:
    """STABLE_PD_CONTROL of a floating tree with spherical, revolute and prismatic joints."""
    return under("ample force", _stable_pd(p, "random_tree.urdf", 5.0, 0.5, 50.0)) | under(
        "little force", _stable_pd(p, "random_tree.urdf", 5.0, 0.5, 0.5)
    )


@scenario()
def stable_pd_revolute(p: Any) -> dict[str, Any]:
    """STABLE_PD_CONTROL of floating robots whose joints have one dof each."""
    return under("arm", _stable_pd(p, "seven_dof.urdf", 200.0, 20.0, 45.0)) | under(
        "tree", _stable_pd(p, "tree.urdf", 100.0, 10.0, 50.0)
    )


@scenario()
def resets_of_many_dofs(p: Any) -> dict[str, Any]:
    """resetJointStateMultiDof and resetJointStatesMultiDof, then some steps."""
    body = _chain(p)
    p.resetJointStatesMultiDof(
        body,
        BALLS,
        [list(p.getQuaternionFromEuler([0.1 * joint, 0.2, -0.3])) for joint in BALLS],
        [[0.1, 0.2, 0.3 * joint] for joint in BALLS],
    )
    results = under("at once", spherical_motion(p, body, BALLS))
    p.resetJointStateMultiDof(body, 1, [0.0, 0.6, 0.0, 0.8])
    results |= under("without velocity", spherical_motion(p, body, BALLS))
    p.resetJointStateMultiDof(body, 2, [0.0, 0.0, 1.2, 1.6], [1.0, 0.0, 0.0])
    results |= under("not normalised", spherical_motion(p, body, BALLS))
    return results | under("moving on", _move(p, body))
