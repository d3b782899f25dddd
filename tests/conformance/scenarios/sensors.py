"""Joint force-torque sensors."""

from __future__ import annotations

from typing import Any

from ..scenario import joint_motion, load, movable_joints, release_motors, scenario, simulate, under


def _watch(p: Any, body: int, joints: list[int]) -> None:
    for joint in joints:
        p.enableJointForceTorqueSensor(body, joint)


def _readings(p: Any, body: int, joints: list[int]) -> dict[str, Any]:
    states = p.getJointStatesMultiDof(body, joints)
    return {"force": [state[2][:3] for state in states], "torque": [state[2][3:] for state in states]}


def _flags(p: Any) -> tuple[tuple[str, int], ...]:
    return (
        ("link frame", 0),
        ("world axes", p.JOINT_FEEDBACK_IN_WORLD_SPACE),
        ("joint frame", p.JOINT_FEEDBACK_IN_JOINT_FRAME),
        ("both", p.JOINT_FEEDBACK_IN_WORLD_SPACE | p.JOINT_FEEDBACK_IN_JOINT_FRAME),
    )


@scenario()
def sensors_on_moving_arm(p: Any) -> dict[str, Any]:
    """Sensors in every joint of a seven-joint arm that follows motors, in all frames."""
    results: dict[str, Any] = {}
    for name, mode in _flags(p):
        p.resetSimulation()
        p.setPhysicsEngineParameter(jointFeedbackMode=mode)
        p.setGravity(0, 0, -9.81)
        body = load(p, "seven_dof.urdf", useFixedBase=True)
        sensed = list(range(p.getNumJoints(body)))
        _watch(p, body, sensed)
        for joint in movable_joints(p, body):
            p.setJointMotorControl2(body, joint, p.POSITION_CONTROL, targetPosition=0.6, force=50)
        results |= under(name, simulate(p, 2.0, lambda b=body, s=sensed: _readings(p, b, s), stride=32))
    return results


@scenario()
def sensors_on_free_arm(p: Any) -> dict[str, Any]:
    """Sensors of a double pendulum that swings freely."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "double_pendulum.urdf", basePosition=[0, 0, 2], useFixedBase=True)
    release_motors(p, body)
    _watch(p, body, [0, 1])
    p.resetJointState(body, 0, 0.9)
    p.resetJointState(body, 1, -0.4)
    return simulate(p, 2.0, lambda: _readings(p, body, [0, 1]) | joint_motion(p, body, [0, 1]))


@scenario()
def sensors_on_floating_tree(p: Any) -> dict[str, Any]:
    """Sensors in a thrown tree with outside forces, motors and a fixed joint, in all frames."""
    results: dict[str, Any] = {}
    for name, mode in _flags(p):
        p.resetSimulation()
        p.setPhysicsEngineParameter(jointFeedbackMode=mode)
        p.setGravity(0, 0, -9.81)
        body = load(p, "tree.urdf", basePosition=[0, 0, 8])
        sensed = list(range(p.getNumJoints(body)))
        _watch(p, body, sensed)
        for joint in movable_joints(p, body):
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.2, force=1.5)
        p.resetBaseVelocity(body, [0, 0, 5], [0.6, 0.3, -0.2])

        def push(step: int, body: int = body) -> None:
            p.applyExternalForce(body, 1, [0.5, 1.0, 0.0], [0.02, 0, 0], p.LINK_FRAME)
            p.applyExternalForce(body, -1, [3.0, 0.0, 4.0], [0, 0.1, 0], p.LINK_FRAME)

        results |= under(name, simulate(p, 2.0, lambda b=body, s=sensed: _readings(p, b, s), push, stride=32))
    return results


@scenario()
def sensors_with_limits_and_substeps(p: Any) -> dict[str, Any]:
    """Sensors while limits bear the load, under 2 substeps; one is switched off on the way."""
    p.setPhysicsEngineParameter(numSubSteps=2)
    p.setGravity(0, 0, -9.81)
    body = load(p, "limits_arm.urdf", useFixedBase=True)
    release_motors(p, body)
    _watch(p, body, [0, 1, 2])
    p.resetJointState(body, 1, 0.0, 3.0)

    def switch(step: int) -> None:
        if step == 240:
            p.enableJointForceTorqueSensor(body, 1, enableSensor=0)

    return simulate(p, 2.0, lambda: _readings(p, body, [0, 1, 2]), switch)


@scenario()
def sensors_on_spherical_chain(p: Any) -> dict[str, Any]:
    """Sensors in spherical joints."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "spherical_chain.urdf", useFixedBase=True)
    release_motors(p, body)
    _watch(p, body, [0, 1, 2])
    for joint in range(3):
        p.resetJointStateMultiDof(body, joint, p.getQuaternionFromEuler([0.3, 0.1, 0.0]), [0.2, 0.0, 0.4])
    return simulate(p, 2.0, lambda: _readings(p, body, [0, 1, 2]))


@scenario()
def motor_impulse_readings(p: Any) -> dict[str, Any]:
    """The motor torque joints report: driven, saturated, off, and under torque commands."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "seven_dof.urdf", useFixedBase=True)
    joints = movable_joints(p, body)

    def control(step: int) -> None:
        if step == 60:
            p.setJointMotorControl2(body, joints[1], p.POSITION_CONTROL, targetPosition=0.8, force=3)
        if step == 120:
            p.setJointMotorControl2(body, joints[3], p.VELOCITY_CONTROL, force=0)
        if step >= 180:
            p.setJointMotorControl2(body, joints[3], p.TORQUE_CONTROL, force=2.0)
        if step == 300:
            p.setTimeStep(1.0 / 480.0)

    return simulate(p, 2.0, lambda: joint_motion(p, body, joints), control)
