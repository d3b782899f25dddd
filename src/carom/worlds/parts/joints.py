"""The joints of a body in many worlds: all of them, or a group."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, overload
from weakref import proxy

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, not_negative, pair
from carom.closed import Closed
from carom.description import JointType
from carom.layouts.codes import SENSED
from carom.layouts.dynamics_parameters import LIMITS
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.common.joint_group import CommonJoints
from carom.scene.dynamics.places import limit_rows
from carom.scene.joint import Joint
from carom.scene.joint_motor import Drives
from carom.scene.joints import JointGroup, Joints, coordinate_rows
from carom.scene.named import HasName
from carom.worlds.batch import Batch
from carom.worlds.chosen import Chosen, Where
from carom.worlds.writing import assign

if TYPE_CHECKING:
    from carom.worlds.parts.joint import JointBatch


class JointGroupBatch(Closed, CommonJoints):
    """Some joints of a body in all worlds, one by one or as arrays over those of them that move.

    Get one as in a lone world: `joints[:7]`, `joints["finger*"]`, `joints[["shoulder", "elbow"]]`. Names are
    those of `JointGroup`; arrays have the world as their first axis, and setters take `where`: a mask of
    worlds (count,), their indices or a slice; None for all. Values are (n, ...) for the n worlds chosen, or
    without that axis for all of them alike.

    Arrays of joints that follow each other are views of the state: writing to them changes it. Those of other
    groups are copies, which can be set as a whole.
    """

    def __init__(self, batch: Batch, joints: JointGroup | None = None) -> None:
        self._batch = batch
        self._state: Any = batch._state
        # That of the body itself would refer to it, and so keep it.
        self._handles = Joints(proxy(batch._body)) if joints is None else joints
        body = batch._body
        movable = [joint.index for joint in self._handles.movable]
        all_movable = [joint for joint in range(body.joint_count) if body.velocity_count[joint]]
        self._places = np.array([all_movable.index(joint) for joint in movable], dtype=np.int64)
        self._many_freedoms = [joint for joint in movable if body.velocity_count[joint] != 1]
        self._dofs = coordinate_rows([(body.velocity_index[it], body.velocity_count[it]) for it in movable])
        self._coordinates = coordinate_rows(
            [(body.position_index[it], body.position_count[it]) for it in movable]
        )
        first = batch._dofs.start
        self._columns = coordinate_rows(
            [(body.velocity_index[it] - first, body.velocity_count[it]) for it in movable]
        )
        self._dof_count = sum(body.velocity_count[joint] for joint in movable)
        self._position_count = sum(body.position_count[joint] for joint in movable)
        self._links = np.array([body.first_link + 1 + joint.index for joint in self._handles], dtype=np.int64)
        self._close()

    def __repr__(self) -> str:
        names = ", ".join(map(repr, self.names)) or "none"
        return f"<JointGroupBatch of {self._batch.name!r} in {self._batch._count} worlds: {names}>"

    @property
    def names(self) -> list[str]:
        """All names, in order."""
        return self._handles.names

    def __len__(self) -> int:
        return len(self._handles)

    def __iter__(self) -> Iterator[JointBatch]:
        return iter([self._one(joint) for joint in self._handles])

    def __contains__(self, name: object) -> bool:
        return name in self._handles

    @overload
    def __getitem__(self, key: int | str | HasName) -> JointBatch: ...
    @overload
    def __getitem__(self, key: slice | Sequence[int | str]) -> JointGroupBatch: ...
    def __getitem__(
        self, key: int | str | HasName | slice | Sequence[int | str]
    ) -> JointBatch | JointGroupBatch:
        """A joint or a group of them, as `JointGroup` finds them.

        Raises:
            IndexError, KeyError, ValueError: As there.
        """
        found = self._handles[key]  # pyright: ignore[reportArgumentType, reportCallIssue]
        if isinstance(found, JointGroup):
            return JointGroupBatch(self._batch, found)
        return self._one(found)

    def _one(self, joint: Joint) -> JointBatch:
        alone = JointGroupBatch(self._batch, JointGroup(joint.body, [joint]))
        return self._batch._parts_of_it.joint(self._batch, alone)

    @property
    def movable(self) -> JointGroupBatch:
        """The joints that are not fixed: their `names` are those of the arrays."""
        return JointGroupBatch(self._batch, self._handles.movable)

    @property
    def columns(self) -> slice | np.ndarray:
        """Columns of these joints in arrays over the velocity coordinates of all; a slice if it can be.

        They have the same columns in arrays over positions unless a spherical joint comes before them.
        """
        return self._columns

    # State

    @property
    def positions(self) -> Array:
        """Position coordinates [rad or m], (count, coordinates); they can be set, and velocities stay."""
        return self._state["position"][:, self._coordinates]

    @positions.setter
    def positions(self, values: ArrayLike) -> None:
        self._fill("position", self._coordinates, self._position_count, values, "positions")

    @property
    def velocities(self) -> Array:
        """Velocity coordinates [rad/s or m/s], (count, dofs); they can be set."""
        return self._state["dof_velocity"][:, self._dofs]

    @velocities.setter
    def velocities(self, values: ArrayLike) -> None:
        self._fill("dof_velocity", self._dofs, self._dof_count, values, "velocities")

    @property
    def torques(self) -> Array:
        """Torques [N m] or forces [N] to apply in the next step, (count, dofs); they can be set."""
        return self._state["dof_torque"][:, self._dofs]

    @torques.setter
    def torques(self, values: ArrayLike) -> None:
        self.set_torques(values)

    def _fill(
        self,
        field: str,
        rows: slice | np.ndarray,
        count: int,
        values: ArrayLike,
        name: str,
        where: Where | None = None,
    ) -> None:
        with self._batch._scene.call_lock:
            worlds = self._batch._chosen(where)
            numbers = worlds.values(self._batch._take(values), (count,), name)
            if isinstance(rows, slice):
                # One statement.
                self._state[field][worlds.rows, rows] = numbers
            else:
                place = np.ix_(worlds.numbers, rows)
                assign((self._state[field], place, numbers))

    def reset(self, positions: ArrayLike, velocities: ArrayLike = 0.0, *, where: Where | None = None) -> None:
        """Set the state of the movable joints without simulation; motors keep their targets.

        Args:
            positions: (n, coordinates) for the n worlds chosen, or (coordinates,) for all.
            velocities: (n, dofs), (dofs,) or one number.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: A shape does not fit, or a number is not finite; no joint has changed.
        """
        with self._batch._scene.call_lock:
            worlds = self._batch._chosen(where)
            worlds.values(self._batch._take(velocities), (self._dof_count,), "velocities")
            self._fill("position", self._coordinates, self._position_count, positions, "positions", where)
            self._fill("dof_velocity", self._dofs, self._dof_count, velocities, "velocities", where)

    @property
    @gated("_batch._scene.call_lock")
    def motor_torques(self) -> Array:
        """Torques [N m] or forces [N] of the motors in the last substep, a copy (count, dofs)."""
        return self._state["dof_motor_impulse"][:, self._dofs] / self._batch._scene.parameters.substep_time

    @property
    @gated("_batch._scene.call_lock")
    def limits(self) -> tuple[Array, Array]:
        """Minimum and maximum positions of movable joints in each world; infinite without a limit; settable.

        Copies (count, movable joints) of what `change_dynamics` sets.

        Raises:
            ValueError: What is set is no pair, has a wrong shape, or a joint had no limits when it was
                copied.
        """
        lower, upper = self._limits()
        shape = (self._batch._count, lower.shape[1])
        return np.broadcast_to(lower, shape).copy(), np.broadcast_to(upper, shape).copy()

    @limits.setter
    def limits(self, value: tuple[ArrayLike, ArrayLike]) -> None:
        least, greatest = pair(value, "limits", "the least and the greatest positions")
        worlds, joints = self._batch._chosen(), [*self.movable]
        lower, upper = (
            worlds.values(np.asarray(self._batch._take(each)), (len(joints),), "limits", finite=False)
            for each in (least, greatest)
        )
        self._set_each("limits", [(lower[:, it], upper[:, it]) for it in range(len(joints))])

    def _terms(self, name: str) -> Array:
        terms = [getattr(joint, name) for joint in self.movable]
        return np.stack(terms, axis=1) if terms else np.zeros((self._batch._count, 0))

    def _set_terms(self, name: str, value: ArrayLike) -> None:
        worlds, count = self._batch._chosen(), len(self._handles.movable)
        values = worlds.values(np.asarray(self._batch._take(value)), (count,), name)
        self._set_each(name, [*not_negative(values, name).T])

    @gated("_batch._scene.call_lock", section=True)
    def _set_each(self, name: str, values: Sequence[Any]) -> None:
        for joint, own in zip(self.movable, values, strict=True):
            setattr(joint, name, own)

    def _limits(self) -> tuple[Array, Array]:
        """`limits` with one row for each world, or one for all if they are the same."""
        engine, movable = self._batch._engine, self._handles.movable
        rows = limit_rows(engine, self._batch._body)
        places = [place for place, joint in enumerate(movable) if joint.index in rows]
        found = [rows[movable[place].index] for place in places]
        model = engine.arrays.model.numpy
        lower, upper = (
            np.repeat(stated[None], len(model[field]), axis=0)
            for stated, field in zip(self._handles.limits, LIMITS.values(), strict=True)
        )
        for limits, field in ((lower, "joint_lower_limit"), (upper, "joint_upper_limit")):
            limits[:, places] = model[LIMITS[field]][:, found]
        return lower, upper

    @property
    def effort_limits(self) -> Array:
        """Maximum forces of the motors according to the file, the same in all worlds; inf without one."""
        return self._handles.effort_limits

    # Sensors

    def enable_sensors(self, enabled: bool = True) -> None:
        """Switch the force-torque sensors of these joints on or off in all worlds."""
        with self._batch._scene.call_lock, uninterrupted:
            batch = self._batch
            table = batch._engine.arrays.model
            model = table.numpy
            links = slice(batch._body.first_link, batch._links.stop)
            sensors = model["link_sensor"][links].copy()
            own = self._links - links.start
            sensors[own] = sensors[own] | SENSED if enabled else sensors[own] & ~SENSED
            count, sensed = int((sensors != 0).sum()), int((sensors & SENSED != 0).sum())
            tree = batch._body_rows.tree
            assign(
                (model["link_sensor"], links, sensors),
                (model["tree_sensor_count"], tree, count),
                (model["tree_sensed_count"], tree, sensed),
            )
            for name in ("link_sensor", "tree_sensor_count", "tree_sensed_count"):
                table.written(name)

    @property
    def reactions(self) -> Array:
        """Force [N] and torque [N m] measured by the joints' sensors in the last substep: (count, joints, 6).

        In the inertial frame of the joint's link, as `Joint.reaction`; 0 without a sensor.
        """
        first, count = self._links[0] if len(self._links) else 0, len(self._links)
        if (self._links == np.arange(first, first + count)).all():
            return self._state["link_reaction"][:, slice(first, first + count)]
        return self._state["link_reaction"][:, self._links]

    # Drives

    @gated("_batch._scene.call_lock", section=True)
    def servo(
        self,
        targets: ArrayLike,
        *,
        kp: ArrayLike | None = None,
        kd: ArrayLike | None = None,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`JointGroup.servo` in all worlds, or in some; each argument (n, dofs), (dofs,) or one number."""
        worlds = self._chosen_one_freedom(where)
        target, rate = (
            self._fitting(worlds, targets, "targets"),
            self._fitting(worlds, velocities, "velocities"),
        )
        if kp is None or kd is None:
            stiffness, damping = (own[worlds.rows] for own in self._present_drives().servo_gains())
            kp, kd = stiffness if kp is None else kp, damping if kd is None else kd
        stiffness, damping = self._fitting(worlds, kp, "kp"), self._fitting(worlds, kd, "kd")
        forces = self._forces(worlds, max_forces)
        with self._drives(worlds) as drives:
            drives.serve(target, rate, stiffness, damping, forces)

    def velocity_servo(
        self,
        targets: ArrayLike,
        *,
        kd: ArrayLike,
        max_forces: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`JointGroup.velocity_servo` in all worlds, or in some."""
        self.servo(0.0, kp=0.0, kd=kd, velocities=targets, max_forces=max_forces, where=where)

    def hold(self, *, max_forces: ArrayLike | None = None, where: Where | None = None) -> None:
        """Hold the joints where they are now, in all worlds or in some, as `JointGroup.hold`."""
        with self._batch._scene.call_lock:
            worlds = self._chosen_one_freedom(where)
            here = np.asarray(self._batch._take(self.positions))[worlds.numbers]
            self.set_position_targets(here, max_forces=max_forces, where=where)

    @gated("_batch._scene.call_lock", section=True)
    def free(self, *, where: Where | None = None) -> None:
        """Switch off motors, servos and springs, in all worlds or in some."""
        with self._drives(self._batch._chosen(where)) as drives:
            drives.switch_off()

    @gated("_batch._scene.call_lock", section=True)
    def set_position_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 0.1,
        velocities: ArrayLike = 0.0,
        velocity_gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        max_velocities: ArrayLike = np.inf,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_position_target` for these joints in all worlds, or in some.

        Args:
            targets: Positions, clipped to the limits: (n, dofs) for the n worlds chosen, (dofs,) or one
                number for all; each of the following likewise.
            gains: Share of the position error corrected per substep.
            velocities: Target velocities.
            velocity_gains: Share of the velocity error corrected per substep.
            max_forces: Maximum forces; those of the file by default.
            max_velocities: Maximum velocities of the motors.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: A joint has more than one degree of freedom, or an argument does not fit.
        """
        worlds = self._chosen_one_freedom(where)
        lower, upper = (limits[worlds.rows] if len(limits) > 1 else limits for limits in self._limits())
        target = np.clip(self._fitting(worlds, targets, "targets"), lower, upper)
        rate = self._fitting(worlds, velocities, "velocities")
        gain = self._fitting(worlds, gains, "gains")
        damping = self._fitting(worlds, velocity_gains, "velocity_gains")
        forces = self._forces(worlds, max_forces)
        fastest = self._fitting(worlds, max_velocities, "max_velocities")
        with self._drives(worlds) as drives:
            drives.aim_at_position(target, rate, gain, damping, forces, fastest)

    @gated("_batch._scene.call_lock", section=True)
    def set_velocity_targets(
        self,
        targets: ArrayLike,
        *,
        gains: ArrayLike = 1.0,
        max_forces: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_velocity_target` for these joints; arguments as for `set_position_targets`."""
        worlds = self._chosen_one_freedom(where)
        target, gain = (
            self._fitting(worlds, value, name) for value, name in ((targets, "targets"), (gains, "gains"))
        )
        forces = self._forces(worlds, max_forces)
        with self._drives(worlds) as drives:
            drives.aim_at_velocity(target, gain, forces)

    @gated("_batch._scene.call_lock", section=True)
    def set_springs(
        self,
        targets: ArrayLike,
        *,
        stiffness: ArrayLike,
        damping: ArrayLike,
        velocities: ArrayLike = 0.0,
        max_forces: ArrayLike | None = None,
        where: Where | None = None,
    ) -> None:
        """`Joint.set_spring` for these joints; arguments as for `set_position_targets`."""
        worlds = self._chosen_one_freedom(where)
        rest = self._fitting(worlds, targets, "targets")
        rate = self._fitting(worlds, velocities, "velocities")
        gains = self._fitting(worlds, stiffness, "stiffness"), self._fitting(worlds, damping, "damping")
        forces = self._forces(worlds, max_forces)
        with self._drives(worlds) as drives:
            drives.pull_like_a_spring(rest, rate, *gains, forces)

    @gated("_batch._scene.call_lock")
    def set_torques(self, torques: ArrayLike, *, where: Where | None = None) -> None:
        """`Joint.set_torque` for these joints: for the next step, replacing those set before.

        Args:
            torques: [N m or N], (n, dofs) for the n worlds chosen, (dofs,) or one number for all.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        worlds = self._batch._chosen(where)
        values = worlds.values(self._batch._take(torques), (self._dof_count,), "torques")
        if isinstance(self._dofs, slice):
            # One statement.
            self._state["dof_torque"][worlds.rows, self._dofs] = values
            return
        with uninterrupted, self._batch._rows_of_dofs(worlds, "dof_torque") as (rows,):
            rows[:, self._columns] = values

    @gated("_batch._scene.call_lock")
    def motors(self) -> dict[str, Array]:
        """What motors are told in each world, by the names of the arguments of `set_position_targets`.

        Returns:
            Copies, (count, dofs). A velocity target has 0 in `gains`, a motor that is off in `max_forces`.

        Raises:
            ValueError: A joint has more than one degree of freedom.
        """
        self._require_one_freedom()
        return self._present_drives().motors()

    @gated("_batch._scene.call_lock")
    def springs(self) -> dict[str, Array]:
        """What springs of joints are told in each world, by the names of the arguments of `set_springs`.

        Returns, Raises: as for `motors`; a spring that is off has 0 in `max_forces`.
        """
        self._require_one_freedom()
        return self._present_drives().springs()

    @contextmanager
    def _drives(self, worlds: Chosen) -> Iterator[Drives]:
        """The drives of the joints in some worlds; what is set is in force at the end."""
        drives = self._present_drives()
        if isinstance(worlds.rows, slice) and drives.change_at_once:
            yield drives
            return
        batch = self._batch
        with batch._rows_of_dofs(worlds, "dof_motor", "dof_pd") as (motor, pd):
            yield Drives(motor, pd, self._columns, batch._scene.parameters.substep_time)

    def _present_drives(self) -> Drives:
        """The drives of the joints in all worlds, to read."""
        batch = self._batch
        motor, pd = self._state["dof_motor"][:, batch._dofs], self._state["dof_pd"][:, batch._dofs]
        return Drives(motor, pd, self._columns, batch._scene.parameters.substep_time)

    def _fitting(self, worlds: Chosen, value: ArrayLike, name: str) -> Array:
        return worlds.fitting(self._batch._take(value), (len(self._places),), name)

    def _forces(self, worlds: Chosen, max_forces: ArrayLike | None) -> Array:
        if max_forces is None:
            return self.effort_limits
        forces = self._fitting(worlds, max_forces, "max_forces")
        return finite(forces, "max_forces") if np.isscalar(max_forces) else forces

    def _chosen_one_freedom(self, where: Where | None) -> Chosen:
        self._require_one_freedom()
        return self._batch._chosen(where)

    def _require_one_freedom(self) -> None:
        for joint in self._many_freedoms:
            spec = self._batch._body.spec.links[joint]
            kind = JointType(spec.joint_type).value
            raise ValueError(f"joint {spec.joint_name!r} is {kind}: it needs one degree of freedom")
