"""Position and velocity motors of one joint, over their parameters."""

from __future__ import annotations

from typing import Any

from ..scenario import joint_motion, load, movable_joints, scenario, simulate, under

SHOULDER = 1


def _arm(p: Any, angle: float = 0.0, speed: float = 0.0) -> int:
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    arm = load(p, "arm_on_world.urdf")
    p.resetJointState(arm, SHOULDER, angle, speed)
    return arm


def _move(p: Any, body: int, joint: int = SHOULDER, **options: Any) -> dict[str, Any]:
    return simulate(p, 2.0, lambda: joint_motion(p, body, [joint]), stride=16, **options)


@scenario()
def position_control_grid(p: Any) -> dict[str, Any]:
    """POSITION_CONTROL over gains and force limits."""
    results: dict[str, Any] = {}
    # A high position gain with a low velocity gain makes this motor diverge, into chaos.
    gains = ((0.02, 0.2), (0.02, 1.0), (0.1, 0.3), (0.1, 1.0), (0.4, 0.8), (0.6, 1.0), (1.0, 1.0))
    for position_gain, velocity_gain in gains:
        for force in (4.0, 14.0, 500.0):
            arm = _arm(p, -0.2)
            p.setJointMotorControl2(
                arm,
                SHOULDER,
                p.POSITION_CONTROL,
                targetPosition=1.0,
                positionGain=position_gain,
                velocityGain=velocity_gain,
                force=force,
            )
            results |= under(f"kp {position_gain}, kd {velocity_gain}, {force} N m", _move(p, arm))
    return results


@scenario()
def position_control_defaults(p: Any) -> dict[str, Any]:
    """POSITION_CONTROL with nothing but a target, and with a target velocity."""
    arm = _arm(p)
    p.setJointMotorControl2(arm, SHOULDER, p.POSITION_CONTROL, targetPosition=0.8)
    results = under("target only", _move(p, arm))
    arm = _arm(p)
    p.setJointMotorControl2(
        arm, SHOULDER, p.POSITION_CONTROL, targetPosition=0.8, targetVelocity=0.5, positionGain=0.05
    )
    return results | under("target velocity", _move(p, arm))


@scenario()
def position_control_speed_bound(p: Any) -> dict[str, Any]:
    """`maxVelocity` bounds the speed until a velocity command forgets it."""
    results: dict[str, Any] = {}
    for bound in (0.3, 1.5):
        arm = _arm(p)

        def control(step: int, arm: int = arm, bound: float = bound) -> None:
            if step == 0:
                p.setJointMotorControl2(
                    arm, SHOULDER, p.POSITION_CONTROL, targetPosition=1.5, force=200, maxVelocity=bound
                )
            if step == 160:
                p.setJointMotorControl2(arm, SHOULDER, p.POSITION_CONTROL, targetPosition=-1.0, force=200)
            if step == 320:
                p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=3.0, force=200)
            if step == 400:
                p.setJointMotorControl2(arm, SHOULDER, p.POSITION_CONTROL, targetPosition=0.0, force=200)

        results |= under(f"{bound} rad/s", _move(p, arm, act=control))
    return results


@scenario()
def velocity_control(p: Any) -> dict[str, Any]:
    """VELOCITY_CONTROL with and without enough force, and with partial gains."""
    results: dict[str, Any] = {}
    for target in (0.7, -2.0):
        for force in (2.0, 8.0, 300.0):
            for gain in (0.1, 1.0):
                arm = _arm(p, 0.3)
                p.setJointMotorControl2(
                    arm, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=target, force=force, velocityGain=gain
                )
                results |= under(f"{target} rad/s, {force} N m, kd {gain}", _move(p, arm))
    return results


@scenario()
def modes_in_turn(p: Any) -> dict[str, Any]:
    """One joint goes through every mode in one run."""
    arm = _arm(p, 0.2)

    def control(step: int) -> None:
        if step == 0:
            p.setJointMotorControl2(arm, SHOULDER, p.POSITION_CONTROL, targetPosition=0.9, force=40)
        elif step == 100:
            p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, targetVelocity=-1.0, force=40)
        elif step == 200:
            p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
        elif 260 <= step < 360:
            p.setJointMotorControl2(arm, SHOULDER, p.TORQUE_CONTROL, force=6.0)
        elif step == 360:
            p.setJointMotorControl2(
                arm,
                SHOULDER,
                p.PD_CONTROL,
                targetPosition=0.5,
                targetVelocity=0.0,
                positionGain=80.0,
                velocityGain=6.0,
                force=50.0,
            )

    return simulate(p, 2.5, lambda: joint_motion(p, arm, [SHOULDER]), control)


@scenario()
def pd_control(p: Any) -> dict[str, Any]:
    """PD_CONTROL: an explicit spring and damper, free and at its force limit."""
    results: dict[str, Any] = {}
    for stiffness, damping, force in ((50.0, 5.0, 1000.0), (300.0, 20.0, 12.0), (5.0, 0.0, 1000.0)):
        arm = _arm(p, -0.5)
        p.setJointMotorControl2(arm, SHOULDER, p.VELOCITY_CONTROL, force=0)
        p.setJointMotorControl2(
            arm,
            SHOULDER,
            p.PD_CONTROL,
            targetPosition=0.8,
            targetVelocity=0.3,
            positionGain=stiffness,
            velocityGain=damping,
            force=force,
        )
        results |= under(f"kp {stiffness}, kd {damping}, {force} N m", _move(p, arm))
    return results


@scenario()
def prismatic_motors(p: Any) -> dict[str, Any]:
    """A carriage on a slanted rail: free, driven by speed, to a place, and by force."""
    results: dict[str, Any] = {}

    def carriage() -> int:
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        body = load(p, "slider.urdf", useFixedBase=True)
        p.setJointMotorControl2(body, 0, p.VELOCITY_CONTROL, force=0)
        return body

    results |= under("free", _move(p, carriage(), 0))
    body = carriage()
    p.setJointMotorControl2(body, 0, p.VELOCITY_CONTROL, targetVelocity=0.2, force=30)
    results |= under("speed", _move(p, body, 0))
    body = carriage()
    p.setJointMotorControl2(body, 0, p.POSITION_CONTROL, targetPosition=0.4, force=12, maxVelocity=0.5)
    results |= under("place", _move(p, body, 0))
    body = carriage()

    def push(step: int) -> None:
        p.setJointMotorControl2(body, 0, p.TORQUE_CONTROL, force=11.0 if step < 240 else 4.0)

    return results | under("force", _move(p, body, 0, act=push))


@scenario()
def fingers_close(p: Any) -> dict[str, Any]:
    """Fingers of a few grams close to their limits and open again, on a fixed and a free palm."""
    results: dict[str, Any] = {}
    for name, fixed in (("fixed", True), ("free", False)):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        hand = load(p, "hand.urdf", basePosition=[0, 0, 5], useFixedBase=fixed)
        joints = movable_joints(p, hand)

        def control(step: int, hand: int = hand, joints: list[int] = joints) -> None:
            if step % 240 == 0:
                target = 1.8 if step == 0 else -0.1
                p.setJointMotorControlArray(
                    hand,
                    joints,
                    p.POSITION_CONTROL,
                    targetPositions=[target] * len(joints),
                    forces=[0.02] * len(joints),
                )

        results |= under(
            name, simulate(p, 2.0, lambda h=hand, j=joints: joint_motion(p, h, j), control, stride=16)
        )
    return results


@scenario()
def old_motor_call(p: Any) -> dict[str, Any]:
    """The positional `setJointMotorControl` of early scripts in its four, five, six and eight arguments."""
    results: dict[str, Any] = {}
    forms = {
        "four": (p.VELOCITY_CONTROL, 0.6),
        "five": (p.POSITION_CONTROL, 0.9, 25.0),
        "six": (p.POSITION_CONTROL, 0.9, 60.0, 0.3),
        "eight": (p.POSITION_CONTROL, 0.9, 0.1, 60.0, 0.3, 0.7),
    }
    for name, arguments in forms.items():
        arm = _arm(p)
        p.setJointMotorControl(arm, SHOULDER, *arguments)
        results |= under(name, _move(p, arm))
    return results
