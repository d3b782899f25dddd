"""What joints do, for plots."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.model.codes import JointCode

if TYPE_CHECKING:
    from carom.world import World

Sample = tuple[int, int, float, float, float, float | None, float | None]

_ONE_FREEDOM = (JointCode.REVOLUTE, JointCode.PRISMATIC)
# Columns of `World.motor`.
_TARGET, _TARGET_VELOCITY, _KP, _KD, _MAX_IMPULSE = range(5)


def sample(world: World, joints: set[tuple[int, int]]) -> list[Sample]:
    """What some joints do now.

    Args:
        world: The world.
        joints: Numbers of their bodies, and their indices. Those that do not exist, or turn about more than
            one axis, are left out.

    Returns:
        Body, joint, position [rad or m], velocity, torque or force of the motor, and the targets of position
        and velocity where the motor has such.
    """
    samples = []
    for number, joint in sorted(joints):
        body = world.bodies.get(number)
        if body is None or not 0 <= joint < body.joint_count or body.joint_types[joint] not in _ONE_FREEDOM:
            continue
        row = body.velocity_index[joint]
        motor = world.motor[row]
        active = motor[_MAX_IMPULSE] > 0.0
        samples.append(
            (
                number,
                joint,
                float(world.position[body.position_index[joint]]),
                float(world.velocity[row]),
                float(world.motor_impulse[row]) / world.parameters.substep_time,
                float(motor[_TARGET]) if active and motor[_KP] != 0.0 else None,
                float(motor[_TARGET_VELOCITY]) if active and motor[_KD] != 0.0 else None,
            )
        )
    return samples
