"""Driving joints and actuators from a page, without code."""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, isfinite
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from carom.scene.joint_motor import Drives

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

Mode = Literal["position", "velocity", "torque"]
MODES: tuple[str, ...] = get_args(Mode)

_GAIN, _VELOCITY_GAIN = 0.1, 1.0
# Maximum force of the drive if the file has no effort limit [N m or N].
_FORCE = 500.0
# Maximum speed of a driven joint [rad/s or m/s]: users move sliders faster than a robot should move.
_SPEED = 2.0
# A motor that wants this speed never reaches it: it applies its maximum force all the time [rad/s or m/s].
_OUT_OF_REACH = 1e6


@dataclass(slots=True)
class _Taken:
    """A joint in the hands of users: its motor and PD drive as the script had set them, and as users did."""

    body: BodyCore
    scripts: NDArray[np.float64]
    users: NDArray[np.float64]


class JointHands:
    """Moves joints by the sliders of pages, and gives them back. Its methods are called between steps.

    Args:
        world: The world.
    """

    def __init__(self, world: WorldCore) -> None:
        self._world = world
        self._taken: dict[tuple[int, int], _Taken] = {}

    def drive(self, body_id: int, joint: int, mode: Mode, target: float, *, place: bool) -> None:
        """Sets the motor of a joint to the value of a slider; joints without exactly one dof are ignored.

        Args:
            body_id: The body.
            joint: The joint.
            mode: What the value is.
            target: Position [rad or m], velocity [rad/s or m/s], or torque or force [N m or N].
            place: For a paused world: also set the position at once.
        """
        body = self._body(body_id, joint)
        if body is None or not isfinite(target):
            return
        world, row = self._world, body.velocity_index[joint]
        taken = self._taken.get((body_id, joint))
        if taken is None or taken.body is not body or not np.array_equal(taken.users, self._rows(row)):
            taken = self._taken[body_id, joint] = _Taken(body, self._rows(row), self._rows(row))
        drives = Drives(world.motor, world.pd, slice(row, row + 1), world.parameters.substep_time)
        drives.switch_off()
        force = body.link_spec(joint).effort or _FORCE
        if mode == "position":
            if place:
                body.set_joint_state(joint, [target], [0.0])
            drives.aim_at_position(target, 0.0, _GAIN, _VELOCITY_GAIN, force, _SPEED)
        elif mode == "velocity":
            drives.aim_at_velocity(target, _VELOCITY_GAIN, force)
        else:
            drives.aim_at_velocity(copysign(_OUT_OF_REACH, target), _VELOCITY_GAIN, abs(target))
        taken.users = self._rows(row)

    def control(self, body_id: int, actuator: int, control: float) -> None:
        """Sets the control of an actuator, until it is set again; unknown ones are ignored."""
        body = self._world.bodies.get(body_id)
        if body is not None and 0 <= actuator < len(body.spec.actuators) and isfinite(control):
            controls = self._world.arrays.state.numpy["actuator_control"][0]
            controls[body.rows.first["actuator"] + actuator] = control

    def give_back(self, body_id: int, joint: int) -> None:
        """Sets the motor of a joint as it was before users took it, unless the script has set it since."""
        body = self._body(body_id, joint)
        taken = self._taken.pop((body_id, joint), None)
        if body is None or taken is None or taken.body is not body:
            return
        row = body.velocity_index[joint]
        if np.array_equal(taken.users, self._rows(row)):
            self._world.motor[row], self._world.pd[row] = taken.scripts

    def _body(self, body_id: int, joint: int) -> BodyCore | None:
        body = self._world.bodies.get(body_id)
        if body is None or not 0 <= joint < body.joint_count or body.velocity_count[joint] != 1:
            return None
        return body

    def _rows(self, row: int) -> NDArray[np.float64]:
        """(2, 8) the rows of a motor and a PD drive."""
        return np.stack((self._world.motor[row], self._world.pd[row]))
