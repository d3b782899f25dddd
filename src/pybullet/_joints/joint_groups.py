"""Access to several joints of a body at once.

Scripts use the same joints in every step of a control loop, so data of a group of joints are cached. If their
rows are contiguous in the state arrays, as for all joints of most arms, one loop reads all states.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from carom.scene.motor_group import MotorGroup
from pybullet._joints.joint_access import NO_WRENCH, AxisJoint, JointAccess, JointState
from pybullet._joints.motor_defaults import DEFAULT_FORCE, DEFAULT_POSITION_GAIN, DEFAULT_VELOCITY_GAIN

if TYPE_CHECKING:
    from carom.native.quick_calls import MotorGroup as MotorRecord
    from pybullet._clients.clients import Client

# Maximum number of cached groups of a body.
_MOST_GROUPS = 64


class JointGroup:
    """A group of joints of any types, handled one by one; base class for the other groups."""

    def __init__(self, client: Client, joints: Sequence[JointAccess]) -> None:
        self.client = client
        self.joints = joints

    def states(self) -> tuple[JointState, ...]:
        """The state of each joint, as `getJointState` returns it."""
        return tuple([joint.state() for joint in self.joints])

    def command(self, mode: int, *lists: Iterable[float] | None) -> None:
        """Set the motor of each joint as `setJointMotorControl2` does. After an error nothing has been set.

        Args:
            mode: Velocity, torque or position control.
            *lists: Positions, velocities, forces, position gains and velocity gains; a number for each joint,
                or None for the defaults.

        Raises:
            ValueError: Some joints are neither revolute nor prismatic, the mode is another one, or a number
                is not finite.
            struct.error: A list does not have a number for each joint.
        """
        raise ValueError("these motors are set one by one")

    @cached_property
    def record(self) -> MotorRecord | None:
        """The group's record for the native library; None if Python handles all commands."""
        return None


class AxisGroup(JointGroup):
    """A group of revolute and prismatic joints, commanded together."""

    def __init__(self, client: Client, joints: Sequence[AxisJoint]) -> None:
        super().__init__(client, joints)
        self._axes = joints

    @cached_property
    def _motors(self) -> MotorGroup:
        return MotorGroup(
            self.client.world,
            [joint.u for joint in self._axes],
            [(joint.motor.lower, joint.motor.upper) for joint in self._axes],
            DEFAULT_FORCE,
            DEFAULT_POSITION_GAIN,
            DEFAULT_VELOCITY_GAIN,
        )

    @cached_property
    def record(self) -> MotorRecord | None:
        return self._motors.record([joint.index for joint in self._axes])

    def command(self, mode: int, *lists: Iterable[float] | None) -> None:
        self._motors.command(mode, self.client.time_step, *lists)


class ConsecutiveAxes(AxisGroup):
    """A group of revolute and prismatic joints without sensors, in consecutive rows of the state arrays."""

    def __init__(self, client: Client, joints: Sequence[AxisJoint]) -> None:
        super().__init__(client, joints)
        first, count = joints[0], len(joints)
        self._positions = first.positions[first.q : first.q + count]
        self._velocities = first.velocities[first.u : first.u + count]
        self._impulses = first.impulses[first.u : first.u + count]

    def states(self) -> tuple[JointState, ...]:
        time_step = self.client.time_step
        return tuple(
            [
                (position, velocity, NO_WRENCH, impulse / time_step)
                for position, velocity, impulse in zip(
                    self._positions, self._velocities, self._impulses, strict=True
                )
            ]
        )


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
        if not axes or len(axes) < len(joints):
            group = JointGroup(self._client, joints)
        elif _are_consecutive(axes) and not any(joint.has_sensor for joint in axes):
            group = ConsecutiveAxes(self._client, axes)
        else:
            group = AxisGroup(self._client, axes)
        if len(self) >= _MOST_GROUPS:
            self.clear()
        self[indices] = group
        return group


def _are_consecutive(joints: Sequence[AxisJoint]) -> bool:
    first = joints[0]
    return all(
        joint.q == first.q + place and joint.u == first.u + place for place, joint in enumerate(joints)
    )
