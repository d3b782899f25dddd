"""Driving joints from a page, without code. Its functions are called between steps."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING

from carom.scene.joint_motor import Drives

if TYPE_CHECKING:
    from carom.world.world import World

_GAIN, _VELOCITY_GAIN = 0.1, 1.0
# Maximum force of the drive if the file has no effort limit [N m or N].
_FORCE = 500.0
# Maximum speed of a driven joint [rad/s or m/s]: users move sliders faster than a robot should move.
_SPEED = 2.0


def drive(world: World, body_id: int, joint: int, target: float, *, place: bool) -> None:
    """Moves a joint to the value of a page's slider [rad or m]; joints without exactly one dof are ignored.

    With `place` it also sets the position at once, for a paused world; otherwise only the motor moves it.
    """
    body = world.bodies.get(body_id)
    if body is None or not 0 <= joint < body.joint_count or not isfinite(target):
        return
    if body.velocity_count[joint] != 1:
        return
    if place:
        body.set_joint_state(joint, [target], [0.0])
    row = body.velocity_index[joint]
    force = body.link_spec(joint).effort or _FORCE
    step = world.parameters.substep_time
    drives = Drives(world.motor, world.pd, slice(row, row + 1), step)
    drives.aim_at_position(target, 0.0, _GAIN, _VELOCITY_GAIN, force, _SPEED)
