"""Several joints of a body at once: all of them, or a group."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, not_negative, one_or_each, pair, vector
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.native.change import Change, first_change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.common.joint_group import CommonJoints
from carom.scene.dynamics.changes import change_limits
from carom.scene.handles import world_of
from carom.scene.joint import Joint
from carom.scene.joint_motor import Drives
from carom.scene.named import Grouped

if TYPE_CHECKING:
    from carom.scene.body import Body

Rows = slice | np.ndarray


class JointGroup(Grouped[Joint, "JointGroup"], CommonJoints):
    """Some joints of a body, one by one or as arrays over those of them that move.

    Get one by a slice, by a pattern of names, or by several numbers and names: `joints[:7]`,
    `joints["finger*"]`, `joints[["shoulder", "elbow"]]`.

    Arrays follow the order of the joints and leave out fixed ones. Those of position coordinates
    have four entries for a spherical joint, those of velocity coordinates three.
    """

    def __init__(self, body: Body, joints: Sequence[Joint]) -> None:
        super().__init__("joint", joints)
        self._body = body
        self._movable = [joint for joint in joints if joint.degrees_of_freedom]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"

    def _repr_html_(self) -> str:
        """A table of the joints, for notebooks."""
        from carom.scene.html_tables import joints_table

        return joints_table(self, f"Joints of {self._body.name}")

    def _group(self, items: list[Joint]) -> JointGroup:
        return JointGroup(self._body, items)

    @property
    def movable(self) -> JointGroup:
        """The joints that are not fixed: their `names` are those of the arrays."""
        return JointGroup(self._body, self._movable)

    # State

    @property
    def positions(self) -> Array:
        """Position coordinates of all movable joints: a copy, read-only; setting them puts the joints there.

        One number is for all. Velocities stay then; `reset` sets them, too.
        """
        with self._body.world.call_lock:
            return _read_only(world_of(self._body).position[self._coordinates].copy())

    @positions.setter
    def positions(self, values: ArrayLike) -> None:
        with self._body.world.call_lock:
            self.reset(values, self.velocities)

    @property
    def velocities(self) -> Array:
        """Velocity coordinates of all movable joints: a copy, read-only; they can be set."""
        with self._body.world.call_lock:
            return _read_only(world_of(self._body).velocity[self._dofs].copy())

    @velocities.setter
    def velocities(self, values: ArrayLike) -> None:
        with self._body.world.call_lock:
            self.reset(self.positions, values)

    @property
    def torques(self) -> Array:
        """Torques or forces of users in the next step: a copy, read-only; setting them is `set_torques`."""
        with self._body.world.call_lock:
            return _read_only(world_of(self._body).joint_torque[self._dofs].copy())

    @torques.setter
    def torques(self, values: ArrayLike) -> None:
        self.set_torques(values)

    @property
    @gated("_body.world.call_lock")
    def motor_torques(self) -> Array:
        """Forces of the motors in the last substep, one for each velocity coordinate."""
        world = world_of(self._body)
        return world.motor_impulse[self._dofs] / world.parameters.substep_time

    @property
    def limits(self) -> tuple[Array, Array]:
        """Minimum and maximum positions of the movable joints; -inf and inf without a limit; settable.

        Raises:
            ValueError: What is set is no pair, or neither is one number, or one for each.
        """
        lower, upper = np.array([joint.limits for joint in self._movable], dtype=float).reshape(-1, 2).T
        return lower, upper

    @limits.setter
    def limits(self, value: tuple[ArrayLike, ArrayLike]) -> None:
        least, greatest = pair(value, "limits", "the least and the greatest positions")
        count = len(self._movable)
        both = one_or_each(least, count, "limits"), one_or_each(greatest, count, "limits")
        pairs = zip(*(each.tolist() for each in both), strict=True)
        for joint in self._movable:
            joint._require_one_freedom()
        change_limits(self._body, dict(zip((joint.index for joint in self._movable), pairs, strict=True)))

    def _terms(self, name: str) -> Array:
        return np.array([getattr(joint, name) for joint in self._movable], dtype=np.float64)

    def _set_terms(self, name: str, value: ArrayLike) -> None:
        values = not_negative(one_or_each(value, len(self._movable), name), name)
        self._set_each(name, finite(values, name).tolist())

    def _set_each(self, name: str, values: Sequence[Any]) -> None:
        with self._body.world.call_lock, uninterrupted:
            for joint, own in zip(self._movable, values, strict=True):
                setattr(joint, name, own)

    @property
    def effort_limits(self) -> Array:
        """Maximum forces of the motors according to the file; inf where it states none."""
        return np.array([joint.effort_limit for joint in self._movable])

    @gated("_body.world.call_lock", commits=True)
    def reset(self, positions: ArrayLike, velocities: ArrayLike = 0.0) -> None:
        """Set the state of all movable joints without simulation; motors keep their targets.

        Those that are coupled to others get the positions given here, too.

        Args:
            positions: All position coordinates, as in `positions`, or one number for all.
            velocities: All velocity coordinates, as in `velocities`, or one number for all.

        Raises:
            ValueError: A number is not finite, there are too many or too few, or a quaternion is 0; no joint
                has changed.
        """
        change = first_change()
        if isinstance(positions, float | int):
            positions = np.full(self._position_count, positions, dtype=np.float64)
        positions = vector(positions, self._position_count, "positions")
        velocities = np.broadcast_to(finite(velocities, "velocities"), self._dof_count)
        q = u = 0
        states = []
        for joint in self._movable:
            q_end, u_end = q + self._body.position_count[joint.index], u + joint.degrees_of_freedom
            states.append((joint.index, *joint._checked_state(positions[q:q_end], velocities[u:u_end])))
            q, u = q_end, u_end
        self._body.note_joint_states(change, states)
        self._body.world.note_link_poses(change, self._body)
        change.commit()

    # Drives

    @gated("_body.world.call_lock", commits=True)
    def set_position_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 0.1,
        velocities: ArrayLike = 0.0,
        velocity_gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        max_velocities: ArrayLike = np.inf,
    ) -> None:
        """`Joint.set_position_target` for all movable joints; scalars apply to all of them.

        Raises:
            ValueError: A joint has more than one degree of freedom, or an argument does not fit.
        """
        change = first_change()
        self._drives(self._one_dof_each, change).aim_at_position(
            np.clip(self._each(targets, "targets"), *self.limits),
            self._each(velocities, "velocities"),
            self._each(gains, "gains"),
            self._each(velocity_gains, "velocity_gains"),
            self._each(self._forces(max_forces), "max_forces"),
            self._each(max_velocities, "max_velocities"),
        )

    @gated("_body.world.call_lock", commits=True)
    def set_velocity_targets(
        self, targets: ArrayLike, *, gains: ArrayLike = 1.0, max_forces: ArrayLike | None = None
    ) -> None:
        """`Joint.set_velocity_target` for all movable joints; scalars apply to all of them."""
        change = first_change()
        self._drives(self._one_dof_each, change).aim_at_velocity(
            self._each(targets, "targets"),
            self._each(gains, "gains"),
            self._each(self._forces(max_forces), "max_forces"),
        )

    @gated("_body.world.call_lock", commits=True)
    def set_torques(self, torques: ArrayLike) -> None:
        """`Joint.set_torque` for all movable joints."""
        change = first_change()
        torques = self._each(finite(torques, "torques"), "torques")
        dofs, rows = self._dofs, world_of(self._body).joint_torque
        if isinstance(dofs, slice):
            change.write(rows[dofs], torques)
        else:
            # A change writes to what lies together: all of the body's.
            told = rows[self._all_dofs].copy()
            told[dofs - self._all_dofs.start] = torques
            change.write(rows[self._all_dofs], told)
        change.commit()

    @gated("_body.world.call_lock", commits=True)
    def set_springs(
        self,
        targets: ArrayLike,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
    ) -> None:
        """`Joint.set_spring` for all movable joints; scalars apply to all of them."""
        change = first_change()
        self._drives(self._one_dof_each, change).pull_like_a_spring(
            self._each(targets, "targets"),
            self._each(velocities, "velocities"),
            self._each(stiffness, "stiffness"),
            self._each(damping, "damping"),
            self._each(self._forces(max_forces), "max_forces"),
        )

    @gated("_body.world.call_lock")
    def motors(self) -> dict[str, Array]:
        """What motors are told, by the names of the arguments of `set_position_targets`.

        Returns:
            Copies, (dofs,). A velocity target has 0 in `gains`, a motor that is off in `max_forces`; gains of
            servos are in N m/rad and so on.
        """
        return self._drives(self._one_dof_each).motors()

    @gated("_body.world.call_lock")
    def springs(self) -> dict[str, Array]:
        """What springs are told, by the names of the arguments of `set_springs`; off ones have force 0."""
        return self._drives(self._one_dof_each).springs()

    @gated("_body.world.call_lock", commits=True)
    def enable_sensors(self, enabled: bool = True) -> None:
        """Switch the force-torque sensors of these joints on or off; they read 0 until the next step."""
        change = first_change()
        world_of(self._body)
        for joint in self:
            self._body.note_sensor(change, joint.index, enabled=enabled)
        change.commit()

    @property
    @gated("_body.world.call_lock")
    def reactions(self) -> Array:
        """What the force-torque sensors have measured, (joints, 6), fixed joints included; see `Joint`."""
        rows = [self._body.first_link + 1 + joint.index for joint in self]
        return world_of(self._body).joint_reaction[rows]

    # Servos

    @gated("_body.world.call_lock", commits=True)
    def servo(
        self,
        targets: ArrayLike,
        *,
        kp: ArrayLike | None = None,
        kd: ArrayLike | None = None,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
    ) -> None:
        """Pull the joints to positions: torque = kp (target - position) + kd (target velocity - velocity).

        Position and velocity are those at the end of a step, so that no gain is too large for it: the law of
        a position actuator of MuJoCo. It holds until motors are told something else; `free` ends it. One
        number is for all of the joints.

        Args:
            targets: [rad or m]; they are not clipped to the limits.
            kp: Stiffness [N m/rad or N/m]; that of their present servos if left out.
            kd: Damping [N m s/rad or N s/m], likewise.
            velocities: Target velocities.
            max_forces: Greatest torques or forces; those of the file (effort) by default.

        Raises:
            ValueError: A joint has more than one degree of freedom, an argument does not fit, or a gain is
                left out and a joint has no servo yet.
        """
        change = first_change()
        drives = self._drives(self._one_dof_each, change)
        if kp is None or kd is None:
            own = drives.servo_gains()
            kp, kd = own[0] if kp is None else kp, own[1] if kd is None else kd
        drives.serve(
            self._each(targets, "targets"),
            self._each(velocities, "velocities"),
            self._each(kp, "kp"),
            self._each(kd, "kd"),
            self._each(self._forces(max_forces), "max_forces"),
        )

    def velocity_servo(
        self, targets: ArrayLike, *, kd: ArrayLike, max_forces: ArrayLike | None = None
    ) -> None:
        """Push the joints to velocities: torque = kd (target - velocity), of the velocity at a step's end."""
        self.servo(0.0, kp=0.0, kd=kd, velocities=targets, max_forces=max_forces)

    def hold(self, *, max_forces: ArrayLike | None = None) -> None:
        """Hold the joints where they are now: PyBullet's position control, as stiff as a step allows.

        Args:
            max_forces: Greatest torques or forces; those of the file (effort) by default.
        """
        with self._body.world.call_lock:
            self.set_position_targets(self.positions, max_forces=max_forces)

    @gated("_body.world.call_lock", commits=True)
    def free(self) -> None:
        """Switch off motors, which are on after loading a URDF file, servos and springs."""
        change = first_change()
        self._drives(self._dofs, change).switch_off()

    # Rows in the world's arrays

    @property
    def _dof_count(self) -> int:
        return sum(joint.degrees_of_freedom for joint in self._movable)

    @property
    def _position_count(self) -> int:
        return sum(self._body.position_count[joint.index] for joint in self._movable)

    @property
    def _dofs(self) -> Rows:
        count, first = self._body.velocity_count, self._body.velocity_index
        return coordinate_rows([(first[joint.index], count[joint.index]) for joint in self._movable])

    @property
    def _coordinates(self) -> Rows:
        count, first = self._body.position_count, self._body.position_index
        return coordinate_rows([(first[joint.index], count[joint.index]) for joint in self._movable])

    @property
    def _all_dofs(self) -> slice:
        first = self._body.first_velocity + BASE_VELOCITIES
        return slice(first, first + sum(self._body.velocity_count))

    @property
    def _one_dof_each(self) -> Rows:
        for joint in self._movable:
            joint._require_one_freedom()
        return self._dofs

    def _drives(self, dofs: Rows, change: Change | None = None) -> Drives:
        world = world_of(self._body)
        if isinstance(dofs, slice):
            return Drives(world.motor, world.pd, dofs, world.parameters.substep_time, change)
        # Only what lies together changes at once: the rows of all joints of the body.
        own = self._all_dofs
        motor, pd = world.motor[own], world.pd[own]
        return Drives(motor, pd, dofs - own.start, world.parameters.substep_time, change)

    def _each(self, value: ArrayLike, name: str) -> Array:
        """One number for each velocity coordinate; an error message names the joints."""
        try:
            return one_or_each(value, self._dof_count, name)
        except ValueError as problem:
            names = ", ".join(joint.name for joint in self._movable)
            raise ValueError(f"{problem}; the movable joints of {self._body.name!r} are {names}") from None

    def _forces(self, max_forces: ArrayLike | None) -> ArrayLike:
        return self.effort_limits if max_forces is None else max_forces


class Joints(JointGroup):
    """All joints of a body: `joints["elbow"]`, `joints[3]`, groups of them, and arrays over the movable ones.

    Arrays follow the order of the joints and leave out fixed ones. Those of position coordinates
    have four entries for a spherical joint, those of velocity coordinates three.
    """

    def __init__(self, body: Body) -> None:
        super().__init__(body, [Joint(body, index) for index in range(body.joint_count)])

    # All lie together.

    @property
    def _dof_count(self) -> int:
        return sum(self._body.velocity_count)

    @property
    def _position_count(self) -> int:
        return sum(self._body.position_count)

    @property
    def _dofs(self) -> slice:
        return self._all_dofs

    @property
    def _coordinates(self) -> slice:
        first = self._body.first_position + BASE_POSITIONS
        return slice(first, first + self._position_count)


def coordinate_rows(parts: Sequence[tuple[int, int]]) -> Rows:
    """The rows of parts, each with its first row and their number: a slice if they follow each other."""
    if not parts:
        return slice(0, 0)
    first = parts[0][0]
    if all(sum(before) == after[0] for before, after in pairwise(parts)):
        return slice(first, sum(parts[-1]))
    return np.concatenate([np.arange(start, start + count) for start, count in parts])


def _read_only(copied: Array) -> Array:
    """Refuse writes to a copy, which would be lost."""
    copied.flags.writeable = False
    return copied
