"""Several joints of a body at once.

Scripts name the same joints in every step of a control loop, so what is known of them is kept. When their
rows follow each other in the state arrays, as they do for all joints of most arms, one loop reads or writes
them all.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import inf
from typing import TYPE_CHECKING

from pybullet._constants import POSITION_CONTROL, TORQUE_CONTROL, VELOCITY_CONTROL
from pybullet._joint_access import (
    NO_WRENCH,
    AxisJoint,
    JointAccess,
    JointState,
    write_target,
    write_target_and_clamp,
)

if TYPE_CHECKING:
    from pybullet._clients import Client

# Groups of one body that are remembered.
_MOST_GROUPS = 64
_NO_CLAMP = -1.0


class JointGroup:
    """Any joints, one after the other. Consecutive axes build on it."""

    def __init__(self, joints: Sequence[JointAccess]) -> None:
        self.joints = joints
        self.count = len(joints)

    def states(self) -> tuple[JointState, ...]:
        """The state of each, as `getJointState` returns it."""
        return tuple([joint.state() for joint in self.joints])

    def command(
        self,
        mode: int,
        positions: Iterable[float],
        velocities: Iterable[float],
        forces: Iterable[float],
        kps: Iterable[float],
        kds: Iterable[float],
    ) -> None:
        """Sets the motor of each by numbers, as many as there are joints, as `setJointMotorControl2` does."""
        for joint, position, velocity, force, kp, kd in zip(
            self.joints, positions, velocities, forces, kps, kds, strict=True
        ):
            joint.command(mode, position, velocity, force, kp, kd, _NO_CLAMP)


class ConsecutiveAxes(JointGroup):
    """Revolute and prismatic joints without sensors, in rows that follow each other."""

    def __init__(self, client: Client, joints: Sequence[AxisJoint]) -> None:
        super().__init__(joints)
        first, count = joints[0], len(joints)
        self._client = client
        self._positions = first.positions[first.q : first.q + count]
        self._velocities = first.velocities[first.u : first.u + count]
        self._impulses = first.impulses[first.u : first.u + count]
        self._torques = first.torques[first.u : first.u + count]
        self._motors = first.motors
        self._targets = [(joint.row_at, joint.lower, joint.upper) for joint in joints]

    def states(self) -> tuple[JointState, ...]:
        time_step = self._client.time_step
        return tuple(
            [
                (position, velocity, NO_WRENCH, impulse / time_step)
                for position, velocity, impulse in zip(
                    self._positions, self._velocities, self._impulses, strict=True
                )
            ]
        )

    def command(
        self,
        mode: int,
        positions: Iterable[float],
        velocities: Iterable[float],
        forces: Iterable[float],
        kps: Iterable[float],
        kds: Iterable[float],
    ) -> None:
        motors, time_step = self._motors, self._client.time_step
        if mode == POSITION_CONTROL:
            for (row_at, lower, upper), position, velocity, force, kp, kd in zip(
                self._targets, positions, velocities, forces, kps, kds, strict=True
            ):
                if not lower <= position <= upper:
                    position = lower if position < lower else upper
                write_target(motors, row_at, position, velocity, kp, kd, force * time_step)
        elif mode == VELOCITY_CONTROL:
            for (row_at, _, _), velocity, force, kd in zip(
                self._targets, velocities, forces, kds, strict=True
            ):
                write_target_and_clamp(motors, row_at, 0.0, velocity, 0.0, kd, force * time_step, inf)
        elif mode == TORQUE_CONTROL:
            torques = self._torques
            for place, force in enumerate(forces):
                torques[place] += force
        else:
            super().command(mode, positions, velocities, forces, kps, kds)


class JointGroups(dict[tuple[int, ...], JointGroup]):
    """The groups of a body's joints by their indices; an entry is made when it is first asked for.

    Asking for a joint that does not exist raises `KeyError`.
    """

    def __init__(self, client: Client, joints: dict[int, JointAccess]) -> None:
        super().__init__()
        self._client = client
        self._joints = joints

    def __missing__(self, indices: tuple[int, ...]) -> JointGroup:
        joints = [self._joints[index] for index in indices]
        axes = [joint for joint in joints if isinstance(joint, AxisJoint) and not joint.has_sensor]
        if joints and len(axes) == len(joints) and _are_consecutive(axes):
            group = ConsecutiveAxes(self._client, axes)
        else:
            group = JointGroup(joints)
        if len(self) >= _MOST_GROUPS:
            self.clear()
        self[indices] = group
        return group


def _are_consecutive(joints: Sequence[AxisJoint]) -> bool:
    first = joints[0]
    return all(
        joint.q == first.q + place and joint.u == first.u + place for place, joint in enumerate(joints)
    )
