"""Substeps, time steps and gravity."""

from __future__ import annotations

from typing import Any

from ..scenario import joint_motion, load, movable_joints, release_motors, scenario, simulate, under

SHOULDER = 1


@scenario()
def substeps_free(p: Any) -> dict[str, Any]:
    """A free arm in 1, 2, 4 and 5 substeps."""
    results: dict[str, Any] = {}
    for count in (1, 2, 4, 5):
        p.resetSimulation()
        p.setPhysicsEngineParameter(numSubSteps=count)
        p.setGravity(0, 0, -9.81)
        body = load(p, "seven_dof.urdf", useFixedBase=True)
        release_motors(p, body)
        joints = movable_joints(p, body)
        for joint in joints:
            p.resetJointState(body, joint, 0.2)
        results |= under(
            f"{count}", simulate(p, 2.0, lambda b=body, j=joints: joint_motion(p, b, j), stride=16)
        )
    return results


@scenario()
def substeps_with_motors(p: Any) -> dict[str, Any]:
    """Motors of every mode, torques and outside forces under 1, 2 and 4 substeps."""
    results: dict[str, Any] = {}
    for count in (1, 2, 4):
        p.resetSimulation()
        p.setPhysicsEngineParameter(numSubSteps=count)
        p.setGravity(0, 0, -9.81)
        body = load(p, "seven_dof.urdf", useFixedBase=True)
        joints = movable_joints(p, body)
        p.setJointMotorControl2(body, joints[0], p.VELOCITY_CONTROL, targetVelocity=0.5, force=5)
        p.setJointMotorControl2(body, joints[1], p.POSITION_CONTROL, targetPosition=0.4, force=30)
        p.setJointMotorControl2(body, joints[2], p.VELOCITY_CONTROL, force=0)
        p.setJointMotorControl2(body, joints[3], p.VELOCITY_CONTROL, force=0)
        p.setJointMotorControl2(
            body, joints[3], p.PD_CONTROL, targetPosition=0.5, positionGain=40, velocityGain=4, force=60
        )

        def push(step: int, body: int = body, joints: list[int] = joints) -> None:
            p.setJointMotorControl2(body, joints[2], p.TORQUE_CONTROL, force=2.0)
            p.applyExternalForce(body, joints[5], [2.0, 1.0, 3.0], [0, 0, 0], p.LINK_FRAME)
            p.applyExternalTorque(body, joints[6], [0.1, 0.0, 0.2], p.WORLD_FRAME)

        results |= under(
            f"{count}", simulate(p, 2.0, lambda b=body, j=joints: joint_motion(p, b, j), push, stride=16)
        )
    return results


@scenario()
def substeps_hit_limits(p: Any) -> dict[str, Any]:
    """Limits hit under 3 substeps."""
    p.setPhysicsEngineParameter(numSubSteps=3)
    p.setGravity(0, 0, -9.81)
    body = load(p, "limits_arm.urdf", useFixedBase=True)
    release_motors(p, body)
    for joint, speed in enumerate((5.0, -4.0, 2.0)):
        p.resetJointState(body, joint, 0.0, speed)
    return simulate(p, 2.0, lambda: joint_motion(p, body, [0, 1, 2]))


@scenario()
def time_step_changes(p: Any) -> dict[str, Any]:
    """The time step and the number of substeps change while motors set before stay."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "arm_on_world.urdf")
    p.setJointMotorControl2(body, SHOULDER, p.POSITION_CONTROL, targetPosition=0.9, force=11)

    def change(step: int) -> None:
        if step == 100:
            p.setTimeStep(1.0 / 100.0)
        if step == 200:
            p.setPhysicsEngineParameter(numSubSteps=4)
        if step == 300:
            p.setPhysicsEngineParameter(fixedTimeStep=1.0 / 500.0, numSubSteps=1)
            p.setJointMotorControl2(body, SHOULDER, p.POSITION_CONTROL, targetPosition=-0.5, force=11)

    return simulate(p, 2.5, lambda: joint_motion(p, body, [SHOULDER]), change)


@scenario()
def gravity_turns(p: Any) -> dict[str, Any]:
    """Gravity changes direction and strength during the motion."""
    body = load(p, "double_pendulum.urdf", useFixedBase=True)
    release_motors(p, body)
    for joint in (0, 1):
        p.changeDynamics(body, joint, jointDamping=0.3)
    directions = ((0, 0, -9.81), (5, 0, 0), (0, -3, -4), (0, 0, 0), (1, 1, 6))

    def turn(step: int) -> None:
        if step % 100 == 0:
            p.setGravity(*directions[(step // 100) % len(directions)])

    return simulate(p, 2.5, lambda: joint_motion(p, body, [0, 1]), turn)


@scenario()
def reset_simulation_keeps_time_step(p: Any) -> dict[str, Any]:
    """After resetSimulation gravity is gone, time step and substeps stay, ids start again."""
    p.setGravity(0, 0, -9.81)
    p.setTimeStep(1.0 / 120.0)
    p.setPhysicsEngineParameter(numSubSteps=2)
    load(p, "slider.urdf")
    first = load(p, "arm_on_world.urdf")
    for _ in range(20):
        p.stepSimulation()
    p.resetSimulation()
    parameters = p.getPhysicsEngineParameters()
    second = load(p, "arm_on_world.urdf")
    p.setJointMotorControl2(second, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(second, SHOULDER, 0.5, 1.0)

    def gravity_returns(step: int) -> None:
        if step == 60:
            p.setGravity(0, 0, -9.81)

    motion = simulate(
        p, 2.0, lambda: joint_motion(p, second, [SHOULDER]), gravity_returns, time_step=1.0 / 120.0, stride=4
    )
    return motion | {
        "ids": [first, second, p.getNumBodies()],
        "parameters": [float(parameters[key]) for key in sorted(parameters)],
    }
