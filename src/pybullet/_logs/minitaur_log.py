"""The log of the Minitaur, a robot with four legs and two motors on each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.transform import rpy_from_quaternion
from pybullet._logs.log_files import BinaryLog

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_MOTORS = (
    "motor_front_leftR_joint",
    "motor_front_leftL_joint",
    "motor_back_leftR_joint",
    "motor_back_leftL_joint",
    "motor_front_rightL_joint",
    "motor_front_rightR_joint",
    "motor_back_rightL_joint",
    "motor_back_rightR_joint",
)
# PyBullet's value for the mode of the motors.
_MODE = 6


class MinitaurLog(BinaryLog):
    """A log of roll, pitch and yaw of the base, position and torque of each motor, and the speed along x."""

    def __init__(self, path: Path, body: Body, motors: Sequence[int]) -> None:
        numbers = [f"{letter}{motor}" for letter in "qu" for motor in range(len(motors))]
        super().__init__(path, ["t", "r", "p", "y", *numbers, "dx", "mo"], "I" + 20 * "f" + "B")
        self._body = body
        self._motors = motors

    def after_substep(self) -> None:
        """Writes a record, unless the robot was removed."""
        body, world = self._body, self._body.world
        if world.bodies.get(body.id) is body:
            first = body.first_position
            x, y, z, w = world.position[first + 3 : first + 7].tolist()
            positions = [world.position[body.position_index[joint]] for joint in self._motors]
            torques = [
                world.motor_impulse[body.velocity_index[joint]] / world.parameters.substep_time
                for joint in self._motors
            ]
            speed = world.velocity[body.first_velocity + 3]
            self._record(*rpy_from_quaternion((x, y, z, w)), *positions, *torques, speed, _MODE)
        self._next(world.parameters.substep_time)

    def _record(self, *values: float) -> None:
        self._write(self._steps, *values)


def minitaur_motors(world: World, bodies: Sequence[int]) -> tuple[Body, list[int]] | None:
    """The first of the bodies and the joints of its motors; None if that body is not a Minitaur."""
    body = world.bodies.get(bodies[0]) if bodies else None
    if body is None:
        return None
    joints = {link.joint_name: index for index, link in enumerate(body.spec.links)}
    motors = [joints[name] for name in _MOTORS if name in joints]
    if len(motors) < len(_MOTORS) or any(body.position_count[joint] != 1 for joint in motors):
        return None
    return body, motors
