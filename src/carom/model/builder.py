"""Writing bodies (`BodySpec`) to rows of the flat arrays, and removing these rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import deepcopy
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description.joint import JOINT_CODE
from carom.description.pose import Pose, Vector3
from carom.description.transform import conjugate, multiplied, rotate, rotation_matrix, subtracted
from carom.layouts.codes import (
    BALLS,
    BASE_POSITIONS,
    BASE_VELOCITIES,
    DOF_COUNT,
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KIND,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY_CLAMP,
    POSITION_COUNT,
    ConstraintKind,
    FluidShape,
    JointCode,
)
from carom.layouts.flags import LoadFlags
from carom.layouts.model import Model, State
from carom.model.actuator_rows import check_joint_ranges, join_actuators, pulled_link, write_actuator
from carom.model.body_rows import BodyRows, TreeRows
from carom.model.body_spec import BASE, BodySpec, LinkSpec
from carom.native.change import Change
from carom.native.products import length, product
from carom.native.row_changes import RowChanges
from carom.native.tables import ROOM_AT_FIRST, ArrayTable, room_ahead

if TYPE_CHECKING:
    from carom.description.fluid import FluidEllipsoid

# Numbers in the status of each of many worlds: a cache line, so that threads do not wait for each other.
_STATUS_ROOM = 16
DEFAULT_SLEEP_THRESHOLD = 0.05
DEFAULT_MOTOR_IMPULSE = 1.0
DEFAULT_SPHERICAL_MOTOR_IMPULSE = 1000.0
DEFAULT_SPHERICAL_MOTOR_GAIN = 0.2

# Fields that contain row numbers, and the axis of these rows; values are updated when rows are removed.
_INDEX_FIELDS = {
    "tree_first_link": "link",
    "tree_first_position": "position",
    "tree_first_velocity": "dof",
    "tree_first_dof": "dof",
    "tree_first_block": "block",
    "tree_first_actuator": "actuator",
    "tree_first_late": "late",
    "tree_first_delta": "delta",
    "link_parent": "link",
    "link_first_position": "position",
    "link_first_dof": "dof",
    "link_nearest_dof": "dof",
    "dof_parent": "dof",
    "tree_batch": "tree",
}
# Terms of joints that are implicit in velocity, in the arrays of dofs.
_TERMS = ("dof_implicit_damping", "dof_armature", "dof_stiffness")


def has_base_terms(spec: BodySpec) -> bool:
    """Whether the base of a body has armature, implicit damping or a spring."""
    base = spec.base
    return not spec.is_held and (base.armature != 0.0 or base.damping != 0.0 or base.stiffness != 0.0)


def has_joint_terms(spec: BodySpec) -> bool:
    """Whether joints of a body have armature, implicit damping or a spring when it is loaded."""
    if has_base_terms(spec):
        return True
    return any(
        link.armature != 0.0 or link.stiffness != 0.0 or (link.damping != 0.0 and not spec.is_held)
        for link in spec.links
    )


def late_links(spec: BodySpec) -> int:
    """The number of links of a body that have late velocities, see `kernels.late`."""
    return len(spec.links) if spec.flags & LoadFlags.GLOBAL_VELOCITIES else 0


class WorldArrays:
    """The arrays of all bodies of `world_count` equal worlds."""

    def __init__(self, world_count: int = 1) -> None:
        self.world_count = world_count
        self.model: ArrayTable = ArrayTable(Model, first_capacity=ROOM_AT_FIRST, references=_INDEX_FIELDS)
        self.state: ArrayTable = ArrayTable(State, world_count, first_capacity=ROOM_AT_FIRST)
        self.used: dict[str, int] = dict.fromkeys(
            (
                "tree",
                "link",
                "position",
                "dof",
                "block",
                "delta",
                "constraint",
                "row",
                "node",
                "actuator",
                "sensor",
                "late",
            ),
            0,
        )
        # The numbers of replacements for which it was made, and it.
        self._row_changes: tuple[tuple[int, int], RowChanges] | None = None
        # Whether rows that are not in use are zero.
        self._is_clear = True

    def repeated(self, world_count: int, user_count: int) -> WorldArrays:
        """Arrays for `world_count` worlds, all copies of the first; they share its parameters.

        The state of each has the rows in use only, `user_count` of user constraints among them.
        """
        other = WorldArrays.__new__(WorldArrays)
        other.world_count = world_count
        other.used = self.used.copy()
        other._row_changes = None
        other._is_clear = True
        other.model = self.model.copy()
        batch = max(self.used["tree"], self.used["constraint"])
        rows = {"user": user_count, "batch": batch, "status": _STATUS_ROOM}
        # What has no room yet gets it before the first step.
        rows = {axis: min(count, self.state.capacity[axis]) for axis, count in rows.items()}
        other.state = self.state.copy(world_count, {**self.used, **rows})
        return other

    def __deepcopy__(self, memo: dict[int, Any]) -> WorldArrays:
        memo[id(self)] = other = WorldArrays.__new__(WorldArrays)
        # The addresses in it are those of the original arrays.
        other.__dict__.update(deepcopy({**self.__dict__, "_row_changes": None}, memo))
        return other

    @property
    def tables(self) -> tuple[ArrayTable, ArrayTable]:
        """Model and state."""
        return self.model, self.state

    @property
    def row_changes(self) -> RowChanges:
        """Changes of rows of all arrays at once."""
        made_for = self.model.replacements, self.state.replacements
        if self._row_changes is None or self._row_changes[0] != made_for:
            changes = RowChanges(
                self.model.row_fields + self.state.row_fields, self.model.row_numbers + self.state.row_numbers
            )
            self._row_changes = made_for, changes
        return self._row_changes[1]

    def reserve(self, **more: int) -> None:
        """Make room for more rows on the named axes."""
        self._make_room(Change(), {axis: self.used[axis] + count for axis, count in more.items()})

    def _make_room(self, change: Change, needed: dict[str, int]) -> None:
        if self.model.lacks(needed) or self.state.lacks(needed):
            # Both at once: what is derived from their arrays is made again if either of them grows.
            change.make_room(self.tables, room_ahead(needed))

    def append(self, change: Change, spec: BodySpec, base_pose: Pose) -> TreeRows:
        """Add a body at rest, its joints at zero, the inertial frame of its base at a world pose.

        It is written to rows that are not in use before the change.
        """
        codes = [JOINT_CODE[link.joint_type] for link in spec.links]
        joint_dofs = sum(DOF_COUNT[code] for code in codes)
        dofs = BASE_VELOCITIES + joint_dofs
        # Room for a free base even where it is fixed, so that it can be freed later.
        blocks = (dofs + 3) // 4
        count = {
            "tree": 1,
            "link": 1 + len(spec.links),
            "position": BASE_POSITIONS + sum(POSITION_COUNT[code] for code in codes),
            "dof": dofs,
            "block": dofs * blocks,
            "delta": blocks,
            "node": 0 if spec.soft is None else len(spec.soft.nodes),
            "actuator": len(spec.actuators),
            "sensor": sum(sensor.memory for sensor in spec.sensors),
            "late": late_links(spec),
        }
        check_joint_ranges(spec.actuators)
        pulled = [pulled_link(spec, actuator) for actuator in spec.actuators]
        used = self._begin(change)
        needed = {**used, **{axis: used[axis] + number for axis, number in count.items()}}
        self._make_room(change, {axis: needed[axis] for axis in count})
        rows = TreeRows(used["tree"], {axis: used[axis] for axis in count}, count)
        self._write_tree(rows, spec)
        self._write_links(rows, spec, codes)
        for row, actuator in enumerate(spec.actuators, start=rows.first["actuator"]):
            write_actuator(self.model.numpy, row, actuator)
        first = rows.first["actuator"]
        self.model.numpy["actuator_pulled"][first : first + len(pulled)] = pulled
        join_actuators(self.model.numpy, rows.first["actuator"], spec.actuators)
        self.set_base_freedom(rows, free=not spec.fixed_base)
        self._write_start(rows, base_pose)
        if spec.soft is not None:
            nodes = slice(rows.first["node"], rows.first["node"] + count["node"])
            turn = np.array(rotation_matrix(base_pose.orientation))
            self.state.numpy["node_position"][:, nodes] = (
                product(spec.soft.nodes, turn.T) + base_pose.position
            )
        self._end(change, needed)
        return rows

    def put(self, change: Change, known: BodyRows, base_pose: Pose) -> TreeRows:
        """Add a body at rest whose rows are known, and return its rows here; see `append`."""
        used, count = self._begin(change), known.count
        needed = {axis: used[axis] + number for axis, number in count.items()}
        self._make_room(change, needed)
        rows = TreeRows(used["tree"], {axis: used[axis] for axis in count}, count)
        self.row_changes.put(known.rows, rows.first, known.packed_count)
        self._write_start(rows, base_pose)
        self._end(change, {**used, **needed})
        return rows

    def _write_tree(self, rows: TreeRows, spec: BodySpec) -> None:
        model = self.model.numpy
        tree, first = rows.tree, rows.first
        model["tree_first_link"][tree] = first["link"]
        model["tree_link_count"][tree] = rows.count["link"]
        model["tree_first_position"][tree] = first["position"]
        model["tree_position_count"][tree] = rows.count["position"]
        model["tree_first_velocity"][tree] = first["dof"]
        model["tree_first_block"][tree] = first["block"]
        model["tree_first_delta"][tree] = first["delta"]
        model["tree_first_actuator"][tree] = first["actuator"]
        model["tree_actuator_count"][tree] = rows.count["actuator"]
        model["tree_first_late"][tree] = first["late"]
        model["tree_late_count"][tree] = rows.count["late"]
        for name in ("sensor_count", "sensed_count", "is_followed"):
            model[f"tree_{name}"][tree] = 0
        model["tree_constraint_count"][tree] = 0
        model["tree_batch"][tree] = tree
        model["tree_linear_damping"][:, tree] = spec.link_damping
        model["tree_angular_damping"][:, tree] = spec.link_damping
        model["tree_max_velocity"][:, tree] = spec.max_velocity
        model["tree_can_sleep"][tree] = bool(spec.flags & LoadFlags.ENABLE_SLEEPING)
        model["tree_can_wake"][tree] = True
        model["tree_sleep_threshold"][tree] = DEFAULT_SLEEP_THRESHOLD

    def _write_links(self, rows: TreeRows, spec: BodySpec, codes: list[JointCode]) -> None:
        model = self.model.numpy
        first_link, first_dof = rows.first["link"], rows.first["dof"]
        model["link_parent"][first_link] = -1
        model["link_joint_type"][first_link] = JointCode.FIXED
        model["link_first_position"][first_link] = rows.first["position"]
        model["link_first_dof"][first_link] = first_dof
        for name in ("dof_damping", *_TERMS):
            model[name][:, first_dof : first_dof + BASE_VELOCITIES] = 0.0
        if not spec.is_held:
            of_base = slice(first_dof, first_dof + BASE_VELOCITIES)
            model["dof_implicit_damping"][:, of_base] = spec.base.damping
            model["dof_armature"][:, of_base] = spec.base.armature
            model["dof_stiffness"][:, of_base] = spec.base.stiffness
        rest = slice(rows.first["position"], rows.first["position"] + BASE_POSITIONS)
        model["position_spring"][:, rest] = spec.base_rest or 0.0
        model["tree_joint_terms"][:, rows.tree] = has_joint_terms(spec)
        self.write_inertia(first_link, spec.base.mass, spec.base.inertia)
        _write_base(model, first_link, spec.base)
        model["link_gravity_compensation"][:, first_link] = spec.base.gravity_compensation
        self._write_fluid(first_link, spec.base.fluid)

        last_dof = {BASE: -1}
        position = rows.first["position"] + BASE_POSITIONS
        dof = first_dof + BASE_VELOCITIES
        for j, (link, code) in enumerate(zip(spec.links, codes, strict=True)):
            row = first_link + 1 + j
            parent = spec.link(link.parent)
            model["link_parent"][row] = first_link + 1 + link.parent
            model["link_joint_type"][row] = code
            model["link_first_position"][row] = position
            model["link_first_dof"][row] = dof
            model["link_dof_count"][row] = DOF_COUNT[code]
            self.write_inertia(row, link.mass, link.inertia)
            model["link_gravity_compensation"][:, row] = link.gravity_compensation
            self._write_fluid(row, link.fluid)
            _write_joint(model, row, link, parent, code)
            last_dof[j] = last_dof[link.parent]
            for _ in range(DOF_COUNT[code]):
                model["dof_parent"][dof] = last_dof[j]
                model["dof_damping"][:, dof] = model["dof_implicit_damping"][:, dof] = 0.0
                model[spec.damping_field][:, dof] = link.damping
                model["dof_armature"][:, dof] = link.armature
                model["dof_stiffness"][:, dof] = link.stiffness
                last_dof[j] = dof
                self._reset_motor(dof, code, held=spec.is_held)
                dof += 1
            if code in BALLS:
                self._reset_spherical(row, position)
            model["position_spring"][:, position : position + POSITION_COUNT[code]] = link.spring_rest
            position += POSITION_COUNT[code]

    def set_base_freedom(self, rows: TreeRows, *, free: bool, change: Change | None = None) -> None:
        """Free the base of a body, or fix it in the world; with a change, if there is one."""
        model = self.model.numpy if change is None else change.arrays(self.model.numpy)
        tree, first, count = rows.tree, rows.first["dof"], rows.count["dof"]
        joints = first + BASE_VELOCITIES
        last_base_dof = joints - 1
        parents = model["dof_parent"]
        roots = [d for d in range(joints, first + count) if parents[d] in (-1, last_base_dof)]
        parents[roots] = last_base_dof if free else -1
        parents[first:joints] = np.arange(first - 1, last_base_dof)
        parents[first] = -1
        _link_dofs(model, rows, last_base_dof if free else -1)
        model["tree_fixed"][tree] = not free
        model["tree_first_dof"][tree] = first if free else joints
        model["tree_dof_count"][tree] = count if free else count - BASE_VELOCITIES
        model["link_dof_count"][rows.first["link"]] = BASE_VELOCITIES if free else 0

    def write_inertia(self, row: int, mass: float, inertia: Vector3) -> None:
        """Set a link's mass [kg] and principal moments [kg m²]."""
        self.model.numpy["link_mass"][:, row] = mass
        self.model.numpy["link_inertia"][:, row] = inertia

    def note_inertia(self, change: Change, row: int, mass: float, inertia: Vector3) -> None:
        """The same with a change."""
        change.write(self.model.numpy["link_mass"][:, row], mass)
        change.write(self.model.numpy["link_inertia"][:, row], inertia)

    def _write_fluid(self, row: int, fluid: FluidEllipsoid | None) -> None:
        """Set what of a link feels the fluid."""
        model = self.model.numpy
        shape = FluidShape.BOX
        if fluid is not None:
            shape = FluidShape.ELLIPSOID if fluid.volume > 0.0 else FluidShape.NONE
            model["link_fluid_shape"][:, row] = (
                *(*fluid.semi_axes, fluid.blunt_drag, fluid.slender_drag),
                *(fluid.angular_drag, fluid.kutta_lift, fluid.magnus_lift),
            )
            model["link_fluid_added"][:, row] = np.ravel(fluid.added())
        model["link_fluid"][row] = shape

    def note_joints(self, change: Change, rows: TreeRows, spec: BodySpec) -> None:
        """Write the frames and axes of a body's joints again with a change of inertial frames."""
        model = change.arrays(self.model.numpy)
        _write_base(model, rows.first["link"], spec.base)
        for j, link in enumerate(spec.links):
            row = rows.first["link"] + 1 + j
            _write_joint(model, row, link, spec.link(link.parent), JOINT_CODE[link.joint_type])

    def _reset_motor(self, dof: int, code: JointCode, *, held: bool) -> None:
        """Write the initial motor of a dof: its target velocity is zero, and without `held` its force too."""
        spherical = MOTOR_KIND.get(code) == ConstraintKind.SPHERICAL_MOTOR
        motor = self.state.numpy["dof_motor"][:, dof]
        motor[:] = 0.0
        motor[:, MOTOR_KP] = DEFAULT_SPHERICAL_MOTOR_GAIN if spherical else 0.0
        motor[:, MOTOR_KD] = 1.0
        if held:
            motor[:, MOTOR_MAX_IMPULSE] = (
                DEFAULT_SPHERICAL_MOTOR_IMPULSE if spherical else DEFAULT_MOTOR_IMPULSE
            )
        motor[:, MOTOR_VELOCITY_CLAMP] = np.inf
        motor[:, MOTOR_DAMPING] = 1.0

    def _reset_spherical(self, row: int, position: int) -> None:
        """Set the position of a spherical joint, and the target of its motor, to no rotation."""
        dof = self.model.numpy["link_first_dof"][row]
        self.state.numpy["dof_motor"][:, dof, MOTOR_TARGET_W] = 1.0
        self.state.numpy["position"][:, position + 3] = 1.0

    def _write_start(self, rows: TreeRows, base_pose: Pose) -> None:
        first = rows.first["position"]
        start = self.state.numpy["position"][:, first : first + BASE_POSITIONS]
        start[:] = (*base_pose.position, *base_pose.orientation)

    def clear_unused(self) -> None:
        """Make rows that are not in use zero: a body that was not added in the end may be in them."""
        if self._is_clear:
            return
        for table in self.tables:
            table.clear_beyond(self.used)
        self._is_clear = True

    def _begin(self, change: Change) -> dict[str, int]:
        """Begin to write to unused rows for a change; returns those in use by what was noted so far."""
        used: dict[str, int] = change.get(self, "used")
        if used is self.used:
            self.clear_unused()
        self._is_clear = False
        return used

    def _end(self, change: Change, used: dict[str, int]) -> None:
        """Note that rows are used, in which a body has been written."""
        change.set(self, "used", used)
        change.set(self, "_is_clear", True)

    def remove(self, change: Change, rows: TreeRows, others: Sequence[TreeRows]) -> list[dict[str, int]]:
        """Remove a body's rows with a change; those of others after it move up.

        Returns:
            The first rows that each of the others will have.
        """
        self.row_changes.cut(change, rows.first, rows.count, self.used)
        used = {axis: self.used[axis] - count for axis, count in rows.count.items()}
        change.set(self, "used", {**self.used, **used})
        gone, count = rows.tree, rows.count
        firsts = [
            {axis: first - count[axis] for axis, first in other.first.items()}
            if other.tree > gone
            else other.first
            for other in others
        ]
        for other, first in zip(others, firsts, strict=True):
            change.set_all(other, first=first, tree=first["tree"])
        return firsts

    def insert(
        self, change: Change, rows: TreeRows, others: Sequence[TreeRows], axis: str, count: int
    ) -> int:
        """Insert rows of zeros on an axis after those of a body with a change; returns the first.

        Those of other bodies after it move down. `change` makes room for them at once.
        """
        used, row = self.used[axis], rows.first[axis] + rows.count[axis]
        change.make_room(self.tables, {axis: used + count})
        for table in self.tables:
            copies = change.arrays(table.numpy)
            for name in table.numpy:
                if table.axis_of(name) == axis:
                    moved = copies[name].swapaxes(0, 1) if table.is_per_world(name) else copies[name]
                    moved[row + count : used + count] = moved[row:used].copy()
                    moved[row : row + count] = 0
        change.set(rows, "count", {**rows.count, axis: rows.count[axis] + count})
        for other in others:
            if other is not rows and other.tree > rows.tree:
                change.set(other, "first", {**other.first, axis: other.first[axis] + count})
        change.put(self.used, axis, used + count)
        return row

    def structs(self) -> dict[str, Any]:
        """C structs whose fields are views of the present arrays, by the names of kernel arguments."""
        return {"model": self.model.struct(), "state": self.state.struct()}


def _link_dofs(model: Mapping[str, np.ndarray], rows: TreeRows, base_dof: int) -> None:
    """Record for each link the last of the dofs that move it."""
    first = rows.first["link"]
    nearest = model["link_nearest_dof"]
    nearest[first] = base_dof
    for row in range(first + 1, first + rows.count["link"]):
        dofs = model["link_dof_count"][row]
        last = model["link_first_dof"][row] + dofs - 1
        nearest[row] = last if dofs else nearest[model["link_parent"][row]]


def _write_base(model: Mapping[str, np.ndarray], row: int, base: LinkSpec) -> None:
    """Write where the centre of mass of a base is, from the origin of its frame."""
    to_inertial = conjugate(base.inertial_frame.orientation)
    model["link_com_from_pivot"][row] = rotate(to_inertial, base.inertial_frame.position)


def _write_joint(
    model: Mapping[str, np.ndarray], row: int, link: LinkSpec, parent: LinkSpec, code: JointCode
) -> None:
    """Write the frames and axes of a joint."""
    to_parent_inertial = conjugate(parent.inertial_frame.orientation)
    to_inertial = conjugate(link.inertial_frame.orientation)
    from_parent_com = subtracted(link.joint_frame.position, parent.inertial_frame.position)
    axis = rotate(to_inertial, link.joint_axis)
    # The length of an axis scales the joint's velocity, not its angle.
    rate = link.joint_axis_length
    model["link_joint_rotation"][row] = multiplied(
        multiplied(to_parent_inertial, link.joint_frame.orientation), link.inertial_frame.orientation
    )
    model["link_pivot_in_parent"][row] = rotate(to_parent_inertial, from_parent_com)
    model["link_com_from_pivot"][row] = rotate(to_inertial, link.inertial_frame.position)
    model["link_unit_axis"][row] = axis
    model["link_axis"][row] = (axis[0] * rate, axis[1] * rate, axis[2] * rate)
    if code == JointCode.PLANAR:
        # Bullet's planar joint acts at the centre of mass.
        model["link_com_from_pivot"][row] = 0.0
        normal = np.asarray(axis) / length(np.asarray(axis))
        aside = np.array([0.0, 1.0, 0.0]) if normal[0] > 0.999 else np.array([1.0, 0.0, 0.0])
        axis1 = np.cross(normal, aside)
        axis1 /= length(axis1)
        model["link_unit_axis"][row] = normal
        model["link_axis"][row] = normal
        model["link_planar_axis1"][row] = axis1
        model["link_planar_axis2"][row] = np.cross(axis1, normal)
    elif code == JointCode.SCREW:
        lead = link.pitch / (2.0 * pi)
        model["link_axis"][row] = axis
        model["link_planar_axis1"][row] = (axis[0] * lead, axis[1] * lead, axis[2] * lead)
