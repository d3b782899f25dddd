"""Direct access to the rows of joints in the state arrays.

These objects are made once per joint and hold the memory of the arrays, so that reading a state or
commanding a motor is a few reads or writes of numbers. They live until bodies are added or removed.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from struct import Struct
from typing import TYPE_CHECKING, TypeGuard

from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
)
from pybullet._calls.arguments import integer
from pybullet._calls.constants import (
    PD_CONTROL,
    POSITION_CONTROL,
    TORQUE_CONTROL,
    VELOCITY_CONTROL,
)
from pybullet._calls.errors import fail

if TYPE_CHECKING:
    from carom.scene.body import Body
    from pybullet._clients.clients import Client

Wrench = tuple[float, ...]
JointState = tuple[float, float, Wrench, float]
MultiDofState = tuple[tuple[float, ...], tuple[float, ...], Wrench, tuple[float, ...]]

ILLEGAL_MODE = "Illegal control mode."
NO_WRENCH = (0.0,) * 6
_DOUBLE = 8
_MOTOR_COLUMNS = 8
_MOTOR_ROW = _MOTOR_COLUMNS * _DOUBLE
_WRENCH_ROW = 6 * _DOUBLE
# The maximum force of a motor that was given a target but no force [N or N m].
_UNSTATED_FORCE = 1000000.0
# The gains of a multi-dof motor whose gains were given in the wrong number.
_UNSTATED_GAIN = 0.1
# A PD drive weaker than this is removed.
_LEAST_PD_FORCE = 1.1920928955078125e-07

# The first columns of a motor's row, as one write: target position, target velocity, kp, kd, maximum
# impulse; then the velocity clamp. The row of a PD drive starts alike, with a force for the impulse.
assert (MOTOR_POSITION, MOTOR_VELOCITY, MOTOR_KP, MOTOR_KD, MOTOR_MAX_IMPULSE, MOTOR_VELOCITY_CLAMP) == (
    0,
    1,
    2,
    3,
    4,
    5,
)
write_target = Struct("5d").pack_into
write_target_and_clamp = Struct("6d").pack_into
_read_wrench = Struct("6d").unpack_from


class JointAccess:
    """A joint without motion: fixed. The other kinds build on it.

    Attributes:
        q: Row of its first position.
        u: Row of its first velocity.
        has_sensor: Its reaction is measured.
    """

    __slots__ = (
        "body",
        "client",
        "has_sensor",
        "impulses",
        "index",
        "motors",
        "pd_drives",
        "positions",
        "q",
        "reaction_at",
        "reactions",
        "torques",
        "u",
        "velocities",
    )

    def __init__(self, client: Client, body: Body, index: int) -> None:
        world = client.world
        self.client = client
        self.body = body
        self.index = index
        self.q = body.position_index[index]
        self.u = body.velocity_index[index]
        self.positions = world.position_memory
        self.velocities = world.velocity_memory
        self.impulses = world.motor_impulse_memory
        self.motors = world.motor_memory
        self.pd_drives = world.pd_memory
        self.torques = world.joint_torque_memory
        self.reactions = world.joint_reaction_memory
        self.has_sensor = body.has_sensor(index)
        self.reaction_at = (body.first_link + 1 + index) * _WRENCH_ROW

    def state(self) -> JointState:
        """Position, velocity, reaction wrench and motor torque, as `getJointState` returns them."""
        return (0.0, 0.0, self._reaction(), 0.0)

    def multi_dof_state(self) -> MultiDofState:
        """The same with a tuple for each of position, velocity and torque."""
        return ((), (), self._reaction(), ())

    def reset(self, position: float, velocity: float) -> None:
        """Sets the state of a joint with one degree of freedom, without physics; ignores other joints."""

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        """Sets the motor by numbers, as `setJointMotorControl2` does.

        Raises:
            pybullet.error: The mode is none of velocity, torque, position and PD control.
        """
        if integer(mode, "controlMode") not in (
            VELOCITY_CONTROL,
            TORQUE_CONTROL,
            POSITION_CONTROL,
            PD_CONTROL,
        ):
            fail(ILLEGAL_MODE, f"{mode} is not a control mode for a single joint.")

    def _reaction(self) -> Wrench:
        return _read_wrench(self.reactions, self.reaction_at) if self.has_sensor else NO_WRENCH

    def add_torques(self, torques: Sequence[float]) -> None:
        """Adds to the torques of the next step; ignored unless there is one for each degree of freedom."""

    def command_multi_dof(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        force: Sequence[float],
        kp: float | Sequence[float],
        kd: float | Sequence[float],
        clamp: float,
        damping: float | Sequence[float],
    ) -> None:
        """Sets the motor by one number for each degree of freedom, as `setJointMotorControlMultiDof` does.

        A sequence of the wrong length counts as not given.
        """

    def command_pd(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        force: Sequence[float],
        kp: float,
        kd: float,
    ) -> None:
        """Sets the explicit PD drive."""


class AxisJoint(JointAccess):
    """A revolute or prismatic joint.

    Attributes:
        lower: Minimum target position; minus infinity without limits.
        upper: Maximum target position.
    """

    __slots__ = ("lower", "row_at", "upper")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        super().__init__(client, body, index)
        self.row_at = self.u * _MOTOR_ROW
        dynamics = body.dynamics(index)
        limited = dynamics.joint_lower_limit <= dynamics.joint_upper_limit
        self.lower = dynamics.joint_lower_limit if limited else -inf
        self.upper = dynamics.joint_upper_limit if limited else inf

    def state(self) -> JointState:
        u = self.u
        return (
            self.positions[self.q],
            self.velocities[u],
            _read_wrench(self.reactions, self.reaction_at) if self.has_sensor else NO_WRENCH,
            self.impulses[u] / self.client.time_step,
        )

    def reset(self, position: float, velocity: float) -> None:
        with self.client.lock:
            self.positions[self.q] = position
            self.velocities[self.u] = velocity
            self.body.update_link_poses()

    def multi_dof_state(self) -> MultiDofState:
        position, velocity, reaction, torque = self.state()
        return ((position,), (velocity,), reaction, (torque,))

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        if mode == POSITION_CONTROL:
            if not self.lower <= position <= self.upper:
                position = self._within_limits(position)
            impulse = float(force) * self.client.time_step
            write_target(self.motors, self.row_at, position, velocity, kp, kd, impulse)
            if clamp > 0.0:
                self.motors[self.u * _MOTOR_COLUMNS + MOTOR_VELOCITY_CLAMP] = clamp
        elif mode == VELOCITY_CONTROL:
            impulse = float(force) * self.client.time_step
            write_target_and_clamp(self.motors, self.row_at, 0.0, velocity, 0.0, kd, impulse, inf)
        elif mode == TORQUE_CONTROL:
            self.torques[self.u] += force
        else:
            super().command(mode, position, velocity, force, kp, kd, clamp)
            self._drive(position, velocity, force, kp, kd)

    def add_torques(self, torques: Sequence[float]) -> None:
        if len(torques) == 1:
            self.torques[self.u] += torques[0]

    def command_multi_dof(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        force: Sequence[float],
        kp: float | Sequence[float],
        kd: float | Sequence[float],
        clamp: float,
        damping: float | Sequence[float],
    ) -> None:
        if clamp > 0.0:
            self.motors[self.u * _MOTOR_COLUMNS + MOTOR_VELOCITY_CLAMP] = clamp
        has_position, has_velocity = len(position) == 1, len(velocity) == 1
        if not (has_position or has_velocity):
            return
        write_target(
            self.motors,
            self.row_at,
            self._within_limits(position[0] if has_position else 0.0),
            velocity[0] if has_velocity else 0.0,
            _first_gain(kp, 1, has_position),
            _first_gain(kd, 1, has_velocity),
            (force[0] if len(force) == 1 else _UNSTATED_FORCE) * self.client.time_step,
        )

    def command_pd(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        force: Sequence[float],
        kp: float,
        kd: float,
    ) -> None:
        has_position, has_velocity = len(position) == 1, len(velocity) == 1
        if has_position or has_velocity:
            self._drive(
                position[0] if has_position else 0.0,
                velocity[0] if has_velocity else 0.0,
                force[0] if len(force) == 1 else _UNSTATED_FORCE,
                kp,
                kd,
            )

    def _within_limits(self, position: float) -> float:
        return self.lower if position < self.lower else self.upper if position > self.upper else position

    def _drive(self, position: float, velocity: float, force: float, kp: float, kd: float) -> None:
        greatest = force if force >= _LEAST_PD_FORCE else 0.0
        write_target(self.pd_drives, self.row_at, self._within_limits(position), velocity, kp, kd, greatest)


class MultiDofJoint(JointAccess):
    """A spherical or planar joint; only the spherical one has a motor."""

    __slots__ = ("dofs", "position_count", "spherical")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        super().__init__(client, body, index)
        self.spherical = body.position_count[index] != body.velocity_count[index]
        # PyBullet reports two of the three coordinates of a planar joint.
        self.position_count = 4 if self.spherical else 2
        self.dofs = 3 if self.spherical else 2

    def state(self) -> JointState:
        return (
            self.positions[self.q],
            self.velocities[self.u],
            self._reaction(),
            0.0,
        )

    def multi_dof_state(self) -> MultiDofState:
        q, u, time_step = self.q, self.u, self.client.time_step
        return (
            tuple(self.positions[q : q + self.position_count].tolist()),
            tuple(self.velocities[u : u + self.dofs].tolist()),
            self._reaction(),
            tuple([impulse / time_step for impulse in self.impulses[u : u + self.dofs].tolist()]),
        )

    def command(
        self, mode: int, position: float, velocity: float, force: float, kp: float, kd: float, clamp: float
    ) -> None:
        super().command(mode, position, velocity, force, kp, kd, clamp)
        if mode == TORQUE_CONTROL:
            self.torques[self.u] += force
        elif mode == POSITION_CONTROL and self.spherical:
            # A single number is not an orientation: it is used as the quaternion's x.
            target = (position, 0.0, 0.0, 0.0) if position else (0.0, 0.0, 0.0, 1.0)
            self._set_motor(
                target, (velocity, 0.0, 0.0), (force,) * 3, (kp,) * 3, (kd,) * 3, (1.0,) * 3, clamp
            )

    def add_torques(self, torques: Sequence[float]) -> None:
        if len(torques) == self.body.velocity_count[self.index]:
            for axis, torque in enumerate(torques):
                self.torques[self.u + axis] += torque

    def command_multi_dof(
        self,
        position: Sequence[float],
        velocity: Sequence[float],
        force: Sequence[float],
        kp: float | Sequence[float],
        kd: float | Sequence[float],
        clamp: float,
        damping: float | Sequence[float],
    ) -> None:
        if not self.spherical:
            return
        has_position, has_velocity = len(position) == 4, len(velocity) == 3
        if not (has_position or has_velocity):
            return
        target = position if has_position else (0.0, 0.0, 0.0, 1.0)
        rate = velocity if has_velocity else (0.0, 0.0, 0.0)
        if _is_triple(force) and _is_triple(kp) and _is_triple(kd):
            forces, kps, kds = force, kp, kd
        else:
            # One value for all axes as soon as one of the three was not given axis by axis.
            greatest = force[0] if len(force) in (1, 3) else _UNSTATED_FORCE
            forces = (greatest,) * 3
            kps = (_first_gain(kp, 3, has_position),) * 3
            kds = (_first_gain(kd, 3, has_velocity),) * 3
        dampings = damping if _is_triple(damping) else (_first_damping(damping),) * 3
        self._set_motor(target, rate, forces, kps, kds, dampings, clamp)

    def _set_motor(
        self,
        target: Sequence[float],
        rate: Sequence[float],
        forces: Sequence[float],
        kps: Sequence[float],
        kds: Sequence[float],
        dampings: Sequence[float],
        clamp: float,
    ) -> None:
        motors, time_step = self.motors, self.client.time_step
        for axis in range(3):
            row = self.u + axis
            write_target(
                motors,
                row * _MOTOR_ROW,
                target[axis],
                rate[axis],
                kps[axis],
                kds[axis],
                forces[axis] * time_step,
            )
            motors[row * _MOTOR_COLUMNS + MOTOR_DAMPING] = dampings[axis]
            if clamp > 0.0:
                motors[row * _MOTOR_COLUMNS + MOTOR_VELOCITY_CLAMP] = clamp
        motors[self.u * _MOTOR_COLUMNS + MOTOR_TARGET_W] = target[3]


def joint_access(client: Client, body: Body, index: int) -> JointAccess:
    """Access to one joint, by its kind."""
    freedoms = body.velocity_count[index]
    if freedoms == 1:
        return AxisJoint(client, body, index)
    return MultiDofJoint(client, body, index) if freedoms else JointAccess(client, body, index)


def _is_triple(values: float | Sequence[float]) -> TypeGuard[Sequence[float]]:
    return not isinstance(values, (int, float)) and len(values) == 3


def _first_gain(gain: float | Sequence[float], dofs: int, targeted: bool) -> float:
    """The gain of the first degree of freedom; a sequence of the wrong length counts as not given."""
    if isinstance(gain, (int, float)):
        return gain
    if len(gain) in (1, dofs):
        return gain[0]
    return _UNSTATED_GAIN if targeted else 0.0


def _first_damping(damping: float | Sequence[float]) -> float:
    if isinstance(damping, (int, float)):
        return damping
    return damping[0] if len(damping) == 1 else 1.0
