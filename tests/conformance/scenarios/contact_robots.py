"""Robots that touch the floor, each other or things in their way, one point at a time.

What touches is round, so that every place has one contact and the motion amplifies no rounding.
"""

from __future__ import annotations

from typing import Any

from ..scenario import base_motion, joint_motion, load, movable_joints, scenario, simulate, under

LEFT_WHEEL, RIGHT_WHEEL, HEAD = 0, 1, 3


def _floor(p: Any) -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[20, 20, 1])
    return p.createMultiBody(0, shape, basePosition=[0, 0, -1])


def _force_on(p: Any, body: int, other: int) -> list[float]:
    contacts = p.getContactPoints(body, other)
    return [sum(contact[9] * contact[7][axis] for contact in contacts) for axis in range(3)]


def _observe_droid(p: Any, body: int, floor: int) -> dict[str, Any]:
    (position, orientation), motion = (
        p.getBasePositionAndOrientation(body),
        joint_motion(p, body, [LEFT_WHEEL, RIGHT_WHEEL]),
    )
    return {
        "base_position": position,
        "base_orientation": orientation,
        "position": motion["position"],
        "normal_force": _force_on(p, body, floor),
    }


@scenario()
def droid_lands_on_its_wheels(p: Any) -> dict[str, Any]:
    """A robot with wheels and a loose head falls on the floor and comes to rest."""
    p.setGravity(0, 0, -9.81)
    floor, body = _floor(p), load(p, "droid.urdf", basePosition=[0, 0, 0.2])

    def observe() -> dict[str, Any]:
        (_, _, height), _ = p.getBasePositionAndOrientation(body)
        position, rate, _, _ = p.getJointState(body, HEAD)
        force = _force_on(p, body, floor)
        return {"height": height, "head": position, "speed_of_head": rate, "normal_force": force}

    return simulate(p, 2.0, observe)


@scenario(tolerance=5e-4)
def droid_drives_a_curve(p: Any) -> dict[str, Any]:
    """Motors turn the wheels of a robot at different speeds; it drives a curve and then brakes.

    The wheels slip as they start, and the order of the three contacts decides how much each. PyBullet's
    depends on what the bounds of its links once met: measured 2.5e-4.
    """
    p.setGravity(0, 0, -9.81)
    floor, body = _floor(p), load(p, "droid.urdf", basePosition=[0, 0, 0.06])

    def drive(step: int) -> None:
        for wheel, speed in ((LEFT_WHEEL, 6.0), (RIGHT_WHEEL, 9.0)):
            target = speed if step < 240 else 0.0
            p.setJointMotorControl2(body, wheel, p.VELOCITY_CONTROL, targetVelocity=target, force=2.0)

    return simulate(p, 2.0, lambda: _observe_droid(p, body, floor), drive)


@scenario()
def arm_presses_on_a_ball(p: Any) -> dict[str, Any]:
    """Position motors push an arm against a fixed ball in its way; the contact bears the rest."""
    p.setGravity(0, 0, -9.81)
    arm = load(p, "seven_dof.urdf", useFixedBase=True)
    ball = p.createMultiBody(
        0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.15), basePosition=[0.45, 0.02, 0.9]
    )
    joints = movable_joints(p, arm)

    def push(step: int) -> None:
        targets = [0.0, min(step / 240.0, 1.2), 0.0, 0.0, 0.0, 0.0, 0.0]
        p.setJointMotorControlArray(
            arm, joints, p.POSITION_CONTROL, targetPositions=targets, forces=[60.0] * len(joints)
        )

    def observe() -> dict[str, Any]:
        return joint_motion(p, arm, joints) | {"force": _force_on(p, arm, ball)}

    return simulate(p, 2.0, observe, push)


@scenario()
def arm_sweeps_a_ball_away(p: Any) -> dict[str, Any]:
    """A swinging arm without motors hits a ball that floats in its way."""
    arm = load(p, "double_pendulum.urdf", basePosition=[0, 0, 0.87], useFixedBase=True)
    ball = p.createMultiBody(
        0.5, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), basePosition=[-0.2, 0.05, 0.1]
    )
    joints = movable_joints(p, arm)
    for joint in joints:
        p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, force=0)
    p.resetJointState(arm, joints[0], -1.0, 3.0)

    def observe() -> dict[str, Any]:
        return under("arm", joint_motion(p, arm, joints)) | under("ball", base_motion(p, ball))

    return simulate(p, 1.0, observe, stride=4)
