"""Joint limits: hit at speed, left behind, and pushed against."""

from __future__ import annotations

from typing import Any

from ..scenario import joint_motion, load, release_motors, scenario, simulate, under

JOINTS = [0, 1, 2]


def _arm(p: Any, fixed: bool = True) -> int:
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    body = load(p, "limits_arm.urdf", basePosition=[0, 0, 2], useFixedBase=fixed)
    release_motors(p, body)
    return body


def _move(p: Any, body: int, **options: Any) -> dict[str, Any]:
    return simulate(p, 2.0, lambda: joint_motion(p, body, JOINTS), **options)


@scenario()
def limits_hit_at_speed(p: Any) -> dict[str, Any]:
    """Revolute and prismatic joints run into their limits at several speeds."""
    results: dict[str, Any] = {}
    for speeds in ((1.0, -0.8, 0.4), (6.0, 5.0, -3.0), (-9.0, -12.0, 6.0)):
        body = _arm(p)
        for joint, speed in zip(JOINTS, speeds, strict=True):
            p.resetJointState(body, joint, 0.0, speed)
        results |= under(f"{speeds} rad/s", _move(p, body))
    return results


@scenario()
def limits_violated_at_start(p: Any) -> dict[str, Any]:
    """Joints placed beyond their limits: small violations are pushed back, large ones only stopped."""
    results: dict[str, Any] = {}
    for violation in (0.0, 0.01, 0.039, 0.05, 0.3):
        body = _arm(p)
        p.resetJointState(body, 0, 0.6 + violation, 0.0)
        p.resetJointState(body, 1, -0.3 - violation, -0.5)
        p.resetJointState(body, 2, 0.15 + violation, 0.2)
        results |= under(f"by {violation}", _move(p, body))
    return results


@scenario()
def motor_against_limit(p: Any) -> dict[str, Any]:
    """Motors and torques press joints against their limits."""
    results: dict[str, Any] = {}
    body = _arm(p)
    p.setJointMotorControl2(body, 0, p.VELOCITY_CONTROL, targetVelocity=2.0, force=300)
    p.setJointMotorControl2(body, 1, p.POSITION_CONTROL, targetPosition=2.0, force=100)
    p.setJointMotorControl2(body, 2, p.VELOCITY_CONTROL, targetVelocity=-1.0, force=60)
    results |= under("motors", _move(p, body))
    body = _arm(p)

    def push(step: int) -> None:
        for joint, force in zip(JOINTS, (40.0, -15.0, 25.0), strict=True):
            p.setJointMotorControl2(body, joint, p.TORQUE_CONTROL, force=force)

    return results | under("torques", _move(p, body, act=push))


@scenario()
def limits_changed_by_code(p: Any) -> dict[str, Any]:
    """changeDynamics narrows the limits in the middle of a motion and weakens their force."""
    body = _arm(p)
    p.resetJointState(body, 1, 0.0, 2.0)

    def change(step: int) -> None:
        if step == 100:
            p.changeDynamics(body, 0, jointLowerLimit=-0.2, jointUpperLimit=0.45)
        if step == 200:
            p.changeDynamics(body, 0, jointLimitForce=2.0)
        if step == 300:
            p.changeDynamics(body, 1, jointLowerLimit=-1.5, jointUpperLimit=1.5)

    return _move(p, body, act=change)


@scenario()
def limits_on_floating_base(p: Any) -> dict[str, Any]:
    """Limits hit while the base is free: the blow turns the whole body."""
    body = _arm(p, fixed=False)
    for joint, speed in zip(JOINTS, (4.0, -6.0, 2.0), strict=True):
        p.resetJointState(body, joint, 0.0, speed)

    def observe() -> dict[str, Any]:
        position, orientation = p.getBasePositionAndOrientation(body)
        return joint_motion(p, body, JOINTS) | {"position": position, "orientation": orientation}

    return simulate(p, 2.0, observe)


@scenario()
def limits_erp(p: Any) -> dict[str, Any]:
    """How fast a violated limit recovers follows the engine's erp."""
    results: dict[str, Any] = {}
    for erp in (0.05, 0.4):
        body = _arm(p)
        p.setPhysicsEngineParameter(erp=erp)
        for joint in JOINTS:
            p.changeDynamics(body, joint, jointDamping=0.5)
        p.resetJointState(body, 0, 0.63, 0.0)
        p.resetJointState(body, 1, -0.32, 0.0)
        results |= under(f"erp {erp}", _move(p, body))
    return results
