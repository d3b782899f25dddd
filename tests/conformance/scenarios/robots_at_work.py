"""Shipped robots doing what scripts do with them."""

from __future__ import annotations

import math
from typing import Any

from ..scenario import (
    base_motion,
    joint_motion,
    load_asset,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)

ARM = list(range(7))
FINGERS = [9, 10]
HOME = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8]


def _panda(p: Any) -> int:
    p.setGravity(0, 0, -9.81)
    panda = load_asset(p, "franka_panda/panda.urdf", useFixedBase=True)
    for joint, angle in zip(ARM, HOME, strict=True):
        p.resetJointState(panda, joint, angle)
    for joint in FINGERS:
        p.resetJointState(panda, joint, 0.02)
    return panda


def _observe(p: Any, panda: int) -> dict[str, Any]:
    hand = p.getLinkState(panda, 11, computeLinkVelocity=1)
    fingers = under("fingers", joint_motion(p, panda, FINGERS))
    return (
        joint_motion(p, panda, ARM)
        | fingers
        | {
            "hand_position": hand[0],
            "hand_orientation": hand[1],
            "hand_velocity": hand[6],
            "hand_spin": hand[7],
        }
    )


@scenario()
def panda_effort(p: Any) -> dict[str, Any]:
    """The Panda under joint torques: gravity compensation plus small waves."""
    panda = _panda(p)
    release_motors(p, panda)
    movable = ARM + FINGERS

    def control(step: int) -> None:
        states = p.getJointStates(panda, movable)
        positions = [state[0] for state in states]
        gravity = p.calculateInverseDynamics(panda, positions, [0.0] * 9, [0.0] * 9)
        wave = [0.6 * math.sin(0.01 * step + joint) for joint in ARM] + [0.0, 0.0]
        damping = [1.5 * state[1] for state in states]
        torques = [g + w - d for g, w, d in zip(gravity, wave, damping, strict=True)]
        p.setJointMotorControlArray(panda, movable, p.TORQUE_CONTROL, forces=torques)

    return simulate(p, 2.0, lambda: _observe(p, panda), control)


@scenario()
def panda_velocity(p: Any) -> dict[str, Any]:
    """The Panda under joint velocity targets that change in steps."""
    panda = _panda(p)

    def control(step: int) -> None:
        if step % 120 == 0:
            sign = 1.0 if (step // 120) % 2 == 0 else -1.0
            targets = [sign * (0.1 + 0.05 * joint) for joint in ARM]
            p.setJointMotorControlArray(
                panda, ARM, p.VELOCITY_CONTROL, targetVelocities=targets, forces=[87.0] * 4 + [12.0] * 3
            )

    return simulate(p, 2.0, lambda: _observe(p, panda), control)


@scenario()
def panda_position(p: Any) -> dict[str, Any]:
    """The Panda follows interpolated position targets set by one array call a step."""
    panda = _panda(p)
    goal = [0.6, 0.1, -0.5, -1.4, 0.4, 2.0, -0.2]
    movable = ARM + FINGERS

    def control(step: int) -> None:
        phase = min(1.0, step / 360.0)
        blend = phase * phase * (3.0 - 2.0 * phase)
        arm = [start + blend * (end - start) for start, end in zip(HOME, goal, strict=True)]
        p.setJointMotorControlArray(
            panda,
            movable,
            p.POSITION_CONTROL,
            targetPositions=[*arm, 0.02 + 0.02 * blend, 0.02 + 0.02 * blend],
            forces=[87.0] * 4 + [12.0] * 3 + [20.0] * 2,
        )

    return simulate(p, 2.0, lambda: _observe(p, panda), control)


@scenario()
def panda_position_gains(p: Any) -> dict[str, Any]:
    """The Panda jumps to a goal with gains of its own for every joint."""
    panda = _panda(p)
    p.setJointMotorControlArray(
        panda,
        ARM,
        p.POSITION_CONTROL,
        targetPositions=[0.5, -0.1, 0.3, -1.6, 0.2, 1.9, 0.1],
        targetVelocities=[0.0] * 7,
        forces=[60.0, 60.0, 60.0, 60.0, 12.0, 12.0, 12.0],
        positionGains=[0.03 + 0.01 * joint for joint in ARM],
        velocityGains=[1.0 - 0.1 * joint for joint in ARM],
    )
    return simulate(p, 2.0, lambda: _observe(p, panda))


@scenario()
def panda_held_and_released(p: Any) -> dict[str, Any]:
    """The Panda held by its default motors, then let go."""
    panda = _panda(p)

    def control(step: int) -> None:
        if step == 120:
            release_motors(p, panda)

    return simulate(p, 2.0, lambda: _observe(p, panda), control)


@scenario()
def kuka_follows(p: Any) -> dict[str, Any]:
    """The KUKA arm follows sine targets, one motor call per joint."""
    p.setGravity(0, 0, -10)
    kuka = load_asset(p, "kuka_iiwa/model.urdf", useFixedBase=True)

    def control(step: int) -> None:
        for joint in ARM:
            p.setJointMotorControl2(
                kuka,
                joint,
                p.POSITION_CONTROL,
                targetPosition=0.5 * math.sin(0.02 * step + 0.7 * joint),
                targetVelocity=0.0,
                force=500,
                positionGain=0.03,
                velocityGain=1.0,
            )

    return simulate(p, 2.0, lambda: joint_motion(p, kuka, ARM), control)


@scenario()
def kuka_falls(p: Any) -> dict[str, Any]:
    """The KUKA arm collapses from a bent pose, its motors off."""
    p.setGravity(0, 0, -9.81)
    kuka = load_asset(p, "kuka_iiwa/model.urdf", useFixedBase=True)
    release_motors(p, kuka)
    for joint in ARM:
        p.resetJointState(kuka, joint, 0.25 * (-1) ** joint)
    return simulate(p, 2.0, lambda: joint_motion(p, kuka, ARM))


@scenario()
def cartpole_balances(p: Any) -> dict[str, Any]:
    """State feedback on the cart's force keeps the pole up."""
    p.setGravity(0, 0, -9.8)
    cartpole = load_asset(p, "cartpole.urdf")
    for joint in (0, 1):
        p.setJointMotorControl2(cartpole, joint, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(cartpole, 1, 0.15)

    def control(step: int) -> None:
        (x, v, *_), (angle, rate, *_) = p.getJointStates(cartpole, [0, 1])
        force = 2.0 * x + 4.0 * v + 90.0 * angle + 22.0 * rate
        p.setJointMotorControl2(cartpole, 0, p.TORQUE_CONTROL, force=force)

    return simulate(p, 3.0, lambda: joint_motion(p, cartpole, [0, 1]), control)


@scenario()
def r2d2_in_the_air(p: Any) -> dict[str, Any]:
    """R2D2, thrown, spins its wheels, turns its head and works its gripper."""
    p.setGravity(0, 0, -9.81)
    r2d2 = load_asset(p, "r2d2.urdf", basePosition=[0, 0, 20])
    joints = movable_joints(p, r2d2)
    for joint in joints:
        name = p.getJointInfo(r2d2, joint)[1].decode()
        if "wheel" in name:
            p.setJointMotorControl2(r2d2, joint, p.VELOCITY_CONTROL, targetVelocity=12.0, force=10)
        elif "head" in name:
            p.setJointMotorControl2(r2d2, joint, p.POSITION_CONTROL, targetPosition=0.8, force=5)
    p.resetBaseVelocity(r2d2, [1.0, 0.0, 2.0], [0.2, 0.3, 0.5])
    return simulate(p, 2.0, lambda: base_motion(p, r2d2) | joint_motion(p, r2d2, joints), stride=16)


@scenario()
def rrbot_swings(p: Any) -> dict[str, Any]:
    """RRBot's two joints swing freely."""
    p.setGravity(0, 0, -9.81)
    rrbot = load_asset(p, "rrbot.urdf", useFixedBase=True)
    release_motors(p, rrbot)
    joints = movable_joints(p, rrbot)
    for joint in joints:
        p.resetJointState(rrbot, joint, 0.6)
    return simulate(p, 2.0, lambda: joint_motion(p, rrbot, joints))
