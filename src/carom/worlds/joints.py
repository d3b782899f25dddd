"""The joints of a body in many worlds: positions, velocities, sensors and drives."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from weakref import proxy

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.description import JointType
from carom.layouts.codes import SENSED
from carom.native.gates import alone, in_section
from carom.native.uninterrupted import uninterrupted
from carom.scene.joint_motor import Drives
from carom.scene.joints import Joints
from carom.worlds.batch import Batch, assign
from carom.worlds.chosen import Chosen, choose
from carom.worlds.dynamics import LIMITS, limit_rows


class JointBatch(Batch):
    """The part of `BodyBatch` that is about joints."""

    @cached_property
    def _joint_handles(self) -> Joints:
        # That of the body itself would refer to it, and so keep it.
        return Joints(proxy(self._body))

    @property
    def joint_positions(self) -> Array:
        """Position coordinates of the joints [rad or m], a view (count, coordinates)."""
        return self._state["position"][:, self._coordinates]

    @joint_positions.setter
    def joint_positions(self, value: ArrayLike) -> None:
        self._fill(self.joint_positions, value, "joint_positions")

    @property
    def joint_velocities(self) -> Array:
        """Velocity coordinates of the joints [rad/s or m/s], a view (count, dofs)."""
        return self._state["dof_velocity"][:, self._dofs]

    @joint_velocities.setter
    def joint_velocities(self, value: ArrayLike) -> None:
        self._fill(self.joint_velocities, value, "joint_velocities")

    @alone("_scene.call_lock")
    def _fill(self, view: Array, value: ArrayLike, name: str) -> None:
        view[:] = self._chosen().values(self._take(value), view.shape[1:], name)

    @property
    def joint_torques(self) -> Array:
        """Torques or forces to apply in the next step; a view (count, dofs)."""
        return self._state["dof_torque"][:, self._dofs]

    @property
    @alone("_scene.call_lock")
    def motor_torques(self) -> Array:
        """Torques [N m] or forces [N] of the motors in the last substep, a copy (count, dofs)."""
        return self._state["dof_motor_impulse"][:, self._dofs] / self._scene.parameters.substep_time

    @property
    @alone("_scene.call_lock")
    def limits(self) -> tuple[Array, Array]:
        """Minimum and maximum positions of movable joints in each world; infinite without a limit.

        Copies (count, movable joints) of what `change_dynamics` sets.
        """
        lower, upper = self._limits()
        shape = (self._count, lower.shape[1])
        return np.broadcast_to(lower, shape).copy(), np.broadcast_to(upper, shape).copy()

    def _limits(self) -> tuple[Array, Array]:
        """`limits` with one row for each world, or one for all if they are the same."""
        rows = limit_rows(self._engine, self._body)
        places = [place for place, joint in enumerate(self._joint_handles.movable) if joint.index in rows]
        found = [rows[self._joint_handles.movable[place].index] for place in places]
        model = self._engine.arrays.model.numpy
        lower, upper = (
            np.repeat(stated[None], len(model[field]), axis=0)
            for stated, field in zip(self._joint_handles.limits, LIMITS.values(), strict=True)
        )
        for limits, field in ((lower, "joint_lower_limit"), (upper, "joint_upper_limit")):
            limits[:, places] = model[LIMITS[field]][:, found]
        return lower, upper

    def columns(self, joints: list[int | str] | None = None) -> slice | np.ndarray:
        """The columns of `joint_velocities` that belong to some joints with one degree of freedom.

        They have the same columns in `joint_positions` unless a spherical joint comes before them.

        Args:
            joints: Which joints, by index or name; None for all movable joints.

        Returns:
            A slice if they are contiguous, so that indexing gives a view.

        Raises:
            ValueError: A joint has more than one degree of freedom, or none.
        """
        columns, _ = self._chosen_joints(joints)
        if not isinstance(columns, slice) and len(columns) and (np.diff(columns) == 1).all():
            return slice(int(columns[0]), int(columns[-1]) + 1)
        return columns

    @in_section("_scene.call_lock")
    def enable_sensors(self, *joints: int | str) -> None:
        """Switch the force-torque sensors of joints on in all worlds; all joints if none is named."""
        chosen = joints or tuple(range(self._body.joint_count))
        table = self._engine.arrays.model
        model = table.numpy
        links = slice(self._body.first_link, self._links.stop)
        sensors = model["link_sensor"][links].copy()
        for joint in chosen:
            sensors[1 + choose("joint", self.joint_names, joint)] |= SENSED
        count, sensed = int((sensors != 0).sum()), int((sensors & SENSED != 0).sum())
        tree = self.rows.tree
        assign(
            (model["link_sensor"], links, sensors),
            (model["tree_sensor_count"], tree, count),
            (model["tree_sensed_count"], tree, sensed),
        )
        for name in ("link_sensor", "tree_sensor_count", "tree_sensed_count"):
            table.written(name)

    @property
    def sensor_wrenches(self) -> Array:
        """Force [N] and torque [N m] measured by the joints' sensors in the last substep: (count, joints, 6).

        A view, in the inertial frame of the joint's link; 0 without a sensor.
        """
        return self._state["link_reaction"][:, self._links]

    # Drives

    @in_section("_scene.call_lock")
    def set_position_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 0.1,
        velocities: ArrayLike = 0.0,
        velocity_gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        max_velocities: ArrayLike = np.inf,
        joints: list[int | str] | None = None,
        where: ArrayLike | None = None,
    ) -> None:
        """`Joint.set_position_target` for joints in all worlds, or in some.

        Args:
            targets: Positions, clipped to the limits: (n, dofs) for the n worlds chosen, (dofs,) or one
                number for all; each of the following likewise.
            gains: Share of the position error corrected per substep.
            velocities: Target velocities.
            velocity_gains: Share of the velocity error corrected per substep.
            max_forces: Maximum forces; those of the file by default.
            max_velocities: Maximum velocities of the motors.
            joints: Which joints, by index or name; None for all movable joints.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: A joint has more than one degree of freedom, or an argument does not fit.
        """
        columns, places = self._chosen_joints(joints)
        worlds, inner = self._chosen(where), (len(places),)
        lower, upper = (
            (limits[worlds.rows] if len(limits) > 1 else limits)[:, places] for limits in self._limits()
        )
        target = np.clip(self._fitting(worlds, targets, inner, "targets"), lower, upper)
        rate = self._fitting(worlds, velocities, inner, "velocities")
        gain = self._fitting(worlds, gains, inner, "gains")
        damping = self._fitting(worlds, velocity_gains, inner, "velocity_gains")
        forces = self._forces(worlds, max_forces, places)
        fastest = self._fitting(worlds, max_velocities, inner, "max_velocities")
        with self._drives(columns, worlds) as drives:
            drives.aim_at_position(target, rate, gain, damping, forces, fastest)

    @in_section("_scene.call_lock")
    def set_velocity_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        joints: list[int | str] | None = None,
        where: ArrayLike | None = None,
    ) -> None:
        """`Joint.set_velocity_target` for joints in many worlds; arguments as for `set_position_targets`."""
        columns, places = self._chosen_joints(joints)
        worlds, inner = self._chosen(where), (len(places),)
        target, gain = (
            self._fitting(worlds, value, inner, name)
            for value, name in ((targets, "targets"), (gains, "gains"))
        )
        forces = self._forces(worlds, max_forces, places)
        with self._drives(columns, worlds) as drives:
            drives.aim_at_velocity(target, gain, forces)

    @in_section("_scene.call_lock")
    def set_springs(
        self,
        targets: ArrayLike,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
        joints: list[int | str] | None = None,
        where: ArrayLike | None = None,
    ) -> None:
        """`Joint.set_spring` for joints in many worlds; arguments as for `set_position_targets`."""
        columns, places = self._chosen_joints(joints)
        worlds, inner = self._chosen(where), (len(places),)
        rest = self._fitting(worlds, targets, inner, "targets")
        rate = self._fitting(worlds, velocities, inner, "velocities")
        gains = (
            self._fitting(worlds, stiffness, inner, "stiffness"),
            self._fitting(worlds, damping, inner, "damping"),
        )
        forces = self._forces(worlds, max_forces, places)
        with self._drives(columns, worlds) as drives:
            drives.pull_like_a_spring(rest, rate, *gains, forces)

    @alone("_scene.call_lock")
    def set_torques(
        self,
        torques: ArrayLike,
        joints: list[int | str] | None = None,
        where: ArrayLike | None = None,
    ) -> None:
        """`Joint.set_torque` for joints in many worlds: for the next step, replacing those set before.

        Args:
            torques: [N m or N], (n, dofs) for the n worlds chosen, (dofs,) or one number for all.
            joints: Which joints, by index or name; None for all movable joints.
            where: Which worlds: a mask (count,) or their indices; None for all.
        """
        columns, places = self._chosen_joints(joints, one_freedom=joints is not None)
        number = len(places) if joints is not None else self._dofs.stop - self._dofs.start
        worlds = self._chosen(where)
        values = worlds.values(self._take(torques), (number,), "torques")
        if isinstance(columns, slice):
            # One statement.
            self._state["dof_torque"][worlds.rows, self._dofs] = values
            return
        with uninterrupted, self._rows_of_dofs(worlds, "dof_torque") as (rows,):
            rows[:, columns] = values

    @in_section("_scene.call_lock")
    def disable_motors(self, joints: list[int | str] | None = None, where: ArrayLike | None = None) -> None:
        """Switch off the motors and springs of joints, in all worlds or in some."""
        columns, _ = self._chosen_joints(joints, one_freedom=joints is not None)
        with self._drives(columns, self._chosen(where)) as drives:
            drives.switch_off()

    @alone("_scene.call_lock")
    def motors(self, joints: list[int | str] | None = None) -> dict[str, Array]:
        """What motors are told in each world, by the names of the arguments of `set_position_targets`.

        Args:
            joints: Which joints, by index or name; None for all movable joints.

        Returns:
            Copies, (count, dofs). A velocity target has 0 in `gains`, a motor that is off in `max_forces`.

        Raises:
            ValueError: A joint has more than one degree of freedom.
        """
        columns, _ = self._chosen_joints(joints)
        return self._present_drives(columns).motors()

    @alone("_scene.call_lock")
    def springs(self, joints: list[int | str] | None = None) -> dict[str, Array]:
        """What springs of joints are told in each world, by the names of the arguments of `set_springs`.

        Args, Returns, Raises: as for `motors`; a spring that is off has 0 in `max_forces`.
        """
        columns, _ = self._chosen_joints(joints)
        return self._present_drives(columns).springs()

    @contextmanager
    def _drives(self, columns: slice | np.ndarray, worlds: Chosen) -> Iterator[Drives]:
        """The drives of some joints in some worlds; what is set is in force at the end."""
        drives = self._present_drives(columns)
        if isinstance(worlds.rows, slice) and drives.change_at_once:
            yield drives
            return
        with self._rows_of_dofs(worlds, "dof_motor", "dof_pd") as (motor, pd):
            yield Drives(motor, pd, columns, self._scene.parameters.substep_time)

    def _present_drives(self, columns: slice | np.ndarray) -> Drives:
        """The drives of some joints in all worlds, to read."""
        motor, pd = self._state["dof_motor"][:, self._dofs], self._state["dof_pd"][:, self._dofs]
        return Drives(motor, pd, columns, self._scene.parameters.substep_time)

    def _fitting(self, worlds: Chosen, value: ArrayLike, inner: tuple[int, ...], name: str) -> Array:
        return worlds.fitting(self._take(value), inner, name)

    def _forces(self, worlds: Chosen, max_forces: ArrayLike | None, places: np.ndarray) -> Array:
        if max_forces is None:
            return self._joint_handles.effort_limits[places]
        forces = self._fitting(worlds, max_forces, (len(places),), "max_forces")
        return finite(forces, "max_forces") if np.isscalar(max_forces) else forces

    def _chosen_joints(
        self, joints: list[int | str] | None, *, one_freedom: bool = True
    ) -> tuple[slice | np.ndarray, np.ndarray]:
        """Columns of `joint_velocities` of some joints, and their indices among all movable joints."""
        body = self._body
        movable = [joint for joint in range(body.joint_count) if body.velocity_count[joint]]
        if joints is None:
            if one_freedom:
                self._require_one_freedom(movable)
            return slice(0, self._dofs.stop - self._dofs.start), np.arange(len(movable))
        chosen = [choose("joint", self.joint_names, joint) for joint in joints]
        self._require_one_freedom(chosen)
        first = self._dofs.start
        return np.array([body.velocity_index[joint] - first for joint in chosen], dtype=np.int64), np.array(
            [movable.index(joint) for joint in chosen], dtype=np.int64
        )

    def _require_one_freedom(self, joints: list[int]) -> None:
        for joint in joints:
            if self._body.velocity_count[joint] != 1:
                kind = JointType(self._body.spec.links[joint].joint_type).value
                raise ValueError(
                    f"joint {self.joint_names[joint]!r} is {kind}: it needs one degree of freedom"
                )
