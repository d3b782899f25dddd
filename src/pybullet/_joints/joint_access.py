"""Direct access to the rows of joints in the state arrays.

A `JointAccess` is created once per joint and keeps views of the arrays, so that reading a state or commanding
a motor takes only a few reads or writes of numbers. It is dropped when bodies are added or removed.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from typing import TYPE_CHECKING, TypeGuard

from carom.layouts.motor_commands import POSITION
from carom.scene.joint_motor import AxisMotor, JointMotor, PlanarMotor, SphericalMotor

if TYPE_CHECKING:
    from carom.scene.body import Body
    from pybullet._clients.clients import Client

Wrench = tuple[float, ...]
JointState = tuple[float, float, Wrench, float]
MultiDofState = tuple[tuple[float, ...], tuple[float, ...], Wrench, tuple[float, ...]]
Gain = float | Sequence[float]
MultiDofCommand = tuple[Sequence[float], Sequence[float], Sequence[float], Gain, Gain, float, Gain]
"""Target position and velocity, maximum force, kp, kd, maximum velocity and damping.

Each sequence has one number for each dof (a position may be a quaternion); one of the wrong length counts as
not given.
"""

NO_WRENCH = (0.0,) * 6
_DOUBLE = 8
_WRENCH_ROW = 6 * _DOUBLE
# The maximum force of a motor that was given a target but no force [N or N m].
_UNSTATED_FORCE = 1000000.0
# The gain of a multi-dof motor if a list of gains has the wrong length.
_UNSTATED_GAIN = 0.1
_read_wrench = Struct("6d").unpack_from


class JointAccess:
    """Direct access to a fixed joint; base class for the other joint types.

    Attributes:
        q: Row of the joint's first position.
        u: Row of its first velocity.
        has_sensor: Whether its reaction force and torque are measured.
        motor: Its motor.
    """

    __slots__ = (
        "body",
        "client",
        "has_sensor",
        "impulses",
        "index",
        "motor",
        "positions",
        "q",
        "reaction_at",
        "reactions",
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
        self.reactions = world.joint_reaction_memory
        self.motor: JointMotor = JointMotor(world, client, self.u)
        self.has_sensor = body.has_sensor(index)
        self.reaction_at = (body.first_link + 1 + index) * _WRENCH_ROW

    def state(self) -> JointState:
        """Position, velocity, reaction wrench and motor torque, as `getJointState` returns them."""
        return (0.0, 0.0, self._reaction(), 0.0)

    def multi_dof_state(self) -> MultiDofState:
        """As `state`, with tuples of positions, velocities and motor torques."""
        return ((), (), self._reaction(), ())

    def reset(self, position: float, velocity: float) -> None:
        """Set the state of a joint with one degree of freedom, without physics.

        Other joints stay as they are; as in PyBullet, getLinkState returns current poses afterwards.
        """
        with self.client.lock:
            self.refresh()

    def refresh(self) -> None:
        """Bring the body up to date as any reset does, also if it changes nothing."""
        self.body.note_reset(moved=False)
        self.body.update_link_poses()

    def _reaction(self) -> Wrench:
        return _read_wrench(self.reactions, self.reaction_at) if self.has_sensor else NO_WRENCH

    def add_torques(self, torques: Sequence[float]) -> None:
        """Add to the torques of the next step; ignored unless there is one for each degree of freedom."""
        if torques and len(torques) == self.body.velocity_count[self.index]:
            self.motor.add_torques(torques)

    def command_multi_dof(self, mode: int, command: MultiDofCommand) -> None:
        """Set the motor or the PD controller, as the functions for joints with several dofs do."""


class AxisJoint(JointAccess):
    """A revolute or prismatic joint."""

    __slots__ = ()

    def __init__(self, client: Client, body: Body, index: int) -> None:
        super().__init__(client, body, index)
        dynamics = body.dynamics(index)
        limits = dynamics.joint_lower_limit, dynamics.joint_upper_limit
        self.motor = AxisMotor(client.world, client, self.u, *limits)

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
            self.body.note_reset(moved=self.positions[self.q] != position)
            self.positions[self.q] = position
            self.velocities[self.u] = velocity
            self.body.update_link_poses()

    def multi_dof_state(self) -> MultiDofState:
        position, velocity, reaction, torque = self.state()
        return ((position,), (velocity,), reaction, (torque,))

    def command_multi_dof(self, mode: int, command: MultiDofCommand) -> None:
        position, velocity, force, kp, kd, clamp, _ = command
        has_position, has_velocity = len(position) == 1, len(velocity) == 1
        if has_position or has_velocity:
            self.motor.command(
                mode,
                position[0] if has_position else 0.0,
                velocity[0] if has_velocity else 0.0,
                force[0] if len(force) == 1 else _UNSTATED_FORCE,
                _first(kp, (1,), _UNSTATED_GAIN if has_position else 0.0),
                _first(kd, (1,), _UNSTATED_GAIN if has_velocity else 0.0),
                clamp,
            )
        elif clamp > 0.0:
            self.motor.clamp(clamp)


class MultiDofJoint(JointAccess):
    """A spherical or planar joint; only the spherical one has a motor."""

    __slots__ = ("dofs", "position_count", "spherical")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        super().__init__(client, body, index)
        self.spherical = body.position_count[index] != body.velocity_count[index]
        # PyBullet reports two of the three coordinates of a planar joint.
        self.position_count = 4 if self.spherical else 2
        self.dofs = 3 if self.spherical else 2
        kind = SphericalMotor if self.spherical else PlanarMotor
        self.motor = kind(client.world, client, self.u)

    def state(self) -> JointState:
        return (self.positions[self.q], self.velocities[self.u], self._reaction(), 0.0)

    def multi_dof_state(self) -> MultiDofState:
        q, u, time_step = self.q, self.u, self.client.time_step
        return (
            tuple(self.positions[q : q + self.position_count].tolist()),
            tuple(self.velocities[u : u + self.dofs].tolist()),
            self._reaction(),
            tuple([impulse / time_step for impulse in self.impulses[u : u + self.dofs].tolist()]),
        )

    def command_multi_dof(self, mode: int, command: MultiDofCommand) -> None:
        motor = self.motor
        if mode != POSITION or not isinstance(motor, SphericalMotor):
            return
        position, velocity, force, kp, kd, clamp, damping = command
        has_position, has_velocity = len(position) == 4, len(velocity) == 3
        if not (has_position or has_velocity):
            return
        target = position if has_position else (0.0, 0.0, 0.0, 1.0)
        rate = velocity if has_velocity else (0.0, 0.0, 0.0)
        if _is_triple(force) and _is_triple(kp) and _is_triple(kd):
            forces, kps, kds = force, kp, kd
        else:
            # Unless forces, kp and kd are all given for each axis, one value of each holds for all axes.
            greatest = force[0] if len(force) in (1, 3) else _UNSTATED_FORCE
            forces = (greatest,) * 3
            kps = (_first(kp, (1, 3), _UNSTATED_GAIN if has_position else 0.0),) * 3
            kds = (_first(kd, (1, 3), _UNSTATED_GAIN if has_velocity else 0.0),) * 3
        dampings = damping if _is_triple(damping) else (_first(damping, (1,), 1.0),) * 3
        motor.aim_at_orientation(target, rate, forces, kps, kds, dampings, clamp)


def joint_access(client: Client, body: Body, index: int) -> JointAccess:
    """Create the access to one joint, in the class for its joint type."""
    freedoms = body.velocity_count[index]
    if freedoms == 1:
        return AxisJoint(client, body, index)
    return MultiDofJoint(client, body, index) if freedoms else JointAccess(client, body, index)


def _is_triple(values: Gain) -> TypeGuard[Sequence[float]]:
    return not isinstance(values, (int, float)) and len(values) == 3


def _first(values: Gain, lengths: tuple[int, ...], otherwise: float) -> float:
    """The number of the first degree of freedom; `otherwise` for a sequence of another length."""
    if isinstance(values, (int, float)):
        return values
    return values[0] if len(values) in lengths else otherwise
