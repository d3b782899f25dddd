"""Commands to several joints of a body at once.

Scripts use the same joints in every step of a control loop, so data of a group of joints are cached.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from carom.scene.motor_group import MotorGroup
from pybullet._joints.joint_access import AxisJoint, JointAccess
from pybullet._joints.motor_defaults import DEFAULT_FORCE, DEFAULT_POSITION_GAIN, DEFAULT_VELOCITY_GAIN

if TYPE_CHECKING:
    from carom.layouts.quick_bodies import MotorGroup as MotorRecord
    from pybullet._clients.clients import Client

# Maximum number of cached groups of a body.
_MAX_GROUPS = 64


class JointGroup:
    """A group of joints of any types, handled one by one; base class for the other group."""

    def command(self, mode: int, *lists: Sequence[float] | None) -> None:
        """Set the motor of each joint as `setJointMotorControl2` does. After an error nothing has been set.

        The lists are positions, velocities, forces, position gains and velocity gains; None for defaults.

        Raises:
            ValueError: Some joints are neither revolute nor prismatic, the mode is another one, a list does
                not have a number for each joint, or a number is not finite.
            struct.error: A list contains something else than numbers.
        """
        raise ValueError("these motors are set one by one")

    @cached_property
    def record(self) -> MotorRecord | None:
        """The group's record for the native library; None if Python handles all commands."""
        return None


class AxisGroup(JointGroup):
    """A group of revolute and prismatic joints, commanded together."""

    def __init__(self, client: Client, joints: Sequence[AxisJoint]) -> None:
        self._client = client
        self._axes = joints

    @cached_property
    def _motors(self) -> MotorGroup:
        return MotorGroup(
            self._client.world,
            [joint.u for joint in self._axes],
            [(joint.motor.lower, joint.motor.upper) for joint in self._axes],
            DEFAULT_FORCE,
            DEFAULT_POSITION_GAIN,
            DEFAULT_VELOCITY_GAIN,
        )

    @cached_property
    def record(self) -> MotorRecord | None:
        return self._motors.record([joint.index for joint in self._axes])

    def command(self, mode: int, *lists: Sequence[float] | None) -> None:
        self._motors.command(mode, self._client.time_step, *lists)


class JointGroups(dict[tuple[int, ...], JointGroup]):
    """Groups of a body's joints, by the tuple of their indices; an entry is created on first use.

    The index of a joint that does not exist raises `KeyError`.
    """

    def __init__(self, client: Client, joints: dict[int, JointAccess]) -> None:
        super().__init__()
        self._client = client
        self._joints = joints

    def __missing__(self, indices: tuple[int, ...]) -> JointGroup:
        joints = [self._joints[index] for index in indices]
        axes = [joint for joint in joints if isinstance(joint, AxisJoint)]
        group = AxisGroup(self._client, axes) if axes and len(axes) == len(joints) else JointGroup()
        if len(self) >= _MAX_GROUPS:
            self.clear()
        self[indices] = group
        return group
