"""The one-joint arm: what a first robotics exercise does with it."""

from __future__ import annotations

import math
from typing import Any

from ..scenario import joint_motion, load, scenario, simulate, under

SHOULDER = 1
MASS, LENGTH, GRAVITY = 2.5, 0.4, 9.81


def _arm(p: Any, angle: float, speed: float = 0.0, motor: bool = False) -> int:
    p.setGravity(0, 0, -GRAVITY)
    arm = load(p, "arm_on_world.urdf")
    if not motor:
        p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(arm, SHOULDER, angle, speed)
    return arm


def _swing(p: Any, arm: int, seconds: float = 2.0, **options: Any) -> dict[str, Any]:
    return simulate(p, seconds, lambda: joint_motion(p, arm, [SHOULDER]), **options)


@scenario()
def arm_falls_freely(p: Any) -> dict[str, Any]:
    """The arm falls from three angles with its motor off."""
    results: dict[str, Any] = {}
    for angle, speed in ((1.2, 0.0), (3.0, 0.0), (-0.4, 5.0)):
        p.resetSimulation()
        arm = _arm(p, angle, speed)
        results |= under(f"from {angle} rad at {speed} rad/s", _swing(p, arm, 3.0))
    return results


@scenario()
def arm_falls_on_a_fixed_base(p: Any) -> dict[str, Any]:
    """The same file, placed and turned, its base fixed by a flag."""
    p.setGravity(0.3, -0.5, -GRAVITY)
    arm = load(
        p,
        "arm_on_world.urdf",
        basePosition=[0.4, -0.7, 2.0],
        baseOrientation=p.getQuaternionFromEuler([0.3, 0.4, -0.8]),
        useFixedBase=True,
    )
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(arm, SHOULDER, 0.9)

    def observe() -> dict[str, Any]:
        link = p.getLinkState(arm, SHOULDER, computeLinkVelocity=1, computeForwardKinematics=1)
        return joint_motion(p, arm, [SHOULDER]) | {
            "com_position": link[0],
            "com_orientation": link[1],
            "com_velocity": link[6],
            "com_spin": link[7],
        }

    return simulate(p, 2.0, observe)


@scenario()
def default_motor_holds(p: Any) -> dict[str, Any]:
    """The motor every joint has by default brakes a fast arm and then holds it against gravity."""
    return _swing(p, _arm(p, 0.8, 12.0, motor=True))


@scenario()
def default_motor_slips(p: Any) -> dict[str, Any]:
    """A heavy arm overcomes the default motor, whose impulse per step is bounded."""
    arm = _arm(p, 1.3, 0.0, motor=True)
    p.changeDynamics(arm, SHOULDER, mass=120.0)
    return _swing(p, arm)


@scenario()
def constant_torque_balances(p: Any) -> dict[str, Any]:
    """A constant torque, started at the angle where it balances gravity and beside it."""
    results: dict[str, Any] = {}
    for offset in (0.0, 0.2):
        p.resetSimulation()
        angle = 0.7
        torque = MASS * GRAVITY * LENGTH * math.sin(angle)
        arm = _arm(p, angle + offset)

        def push(step: int, arm: int = arm, torque: float = torque) -> None:
            p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=torque)

        results |= under(f"{offset} rad beside", _swing(p, arm, act=push))
    return results


@scenario()
def torque_calls_add_up(p: Any) -> dict[str, Any]:
    """Several torque commands before one step add up; the motor beside them stays on."""
    arm = _arm(p, 0.1, motor=True)
    p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=0.0, force=3.0)

    def push(step: int) -> None:
        if step % 3 != 2:
            p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=9.0)
            p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=-2.5 * (step % 2))

    return _swing(p, arm, act=push)


def _pid(p: Any, time_step: float) -> dict[str, Any]:
    p.setTimeStep(time_step)
    arm = _arm(p, 0.0)
    target, kp, ki, kd, bound = 1.1, 60.0, 25.0, 9.0, 30.0
    integral = 0.0
    previous = target

    def control(step: int) -> None:
        nonlocal integral, previous
        error = target - p.getJointState(arm, SHOULDER)[0]
        integral += error * time_step
        torque = kp * error + ki * integral + kd * (error - previous) / time_step
        previous = error
        p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=max(-bound, min(bound, torque)))

    stride = max(1, round(8 / 240 / time_step))
    return _swing(p, arm, 3.0, act=control, time_step=time_step, stride=stride)


@scenario()
def pid_at_1000_hz(p: Any) -> dict[str, Any]:
    """A PID loop on the torque at 1/1000 s."""
    return _pid(p, 1.0 / 1000.0)


@scenario()
def pid_at_240_hz(p: Any) -> dict[str, Any]:
    """A PID loop on the torque at 1/240 s."""
    return _pid(p, 1.0 / 240.0)


@scenario()
def pid_at_60_hz(p: Any) -> dict[str, Any]:
    """A PID loop on the torque at 1/60 s."""
    return _pid(p, 1.0 / 60.0)


@scenario()
def joint_damping_brakes(p: Any) -> dict[str, Any]:
    """Joint damping set by code, from weak to strong enough to ring at this time step."""
    results: dict[str, Any] = {}
    for damping in (0.1, 3.0, 60.0, 150.0):
        p.resetSimulation()
        arm = _arm(p, 1.0, 2.0)
        p.changeDynamics(arm, SHOULDER, jointDamping=damping)
        results |= under(f"{damping} N m s", _swing(p, arm))
    return results


@scenario()
def link_damping_brakes(p: Any) -> dict[str, Any]:
    """Linear and angular damping of links, off and strong."""
    results: dict[str, Any] = {}
    for linear, angular in ((0.0, 0.0), (0.6, 0.0), (0.0, 0.9), (2.0, 3.0)):
        p.resetSimulation()
        arm = _arm(p, 1.0, 6.0)
        p.changeDynamics(arm, -1, linearDamping=linear, angularDamping=angular)
        results |= under(f"linear {linear}, angular {angular}", _swing(p, arm))
    return results
