"""Controls and parameters of a world by which steps are linearised, and where they are stored."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from difflib import get_close_matches
from typing import TYPE_CHECKING, NamedTuple

from carom.layouts.codes import (
    DRIVEN,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
    ConstraintKind,
)
from carom.linearization.tangent import TangentSpace, body_label
from carom.model.body_spec import BASE

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

_AXES = "xyz"
INERTIAL = "inertial_parameters"
OFFSETS = "offsets"
OFFSET_FIELD = "link_pivot_in_parent"
# In the order of `carom.algorithms.inertial_parameters`.
INERTIAL_NUMBERS = (
    *("mass", "moment.x", "moment.y", "moment.z"),
    *("inertia.xx", "inertia.xy", "inertia.yy", "inertia.xz", "inertia.yz", "inertia.zz"),
)


class Input(NamedTuple):
    """One number by which a step is linearised.

    Attributes:
        kind: What it is, of `CONTROLS` or `PARAMETERS`.
        name: Its full name.
        table: The table it is stored in: "state", "model" or "shapes".
        field: The field there.
        place: Indices of the number in the field, after that of the world.
        scale: What is stored, per unit of the number.
        row: Row of its dof in the tangent space, of its link, or of its actuator.
        copies: So many rows hold it, from this one on.
    """

    kind: str
    name: str
    table: str
    field: str
    place: tuple[int, ...]
    scale: float
    row: int
    copies: int = 1

    def places(self) -> list[tuple[int, ...]]:
        """All places that hold the number."""
        first, *others = self.place
        return [(first + number, *others) for number in range(self.copies)]


Finder = Callable[["WorldCore", TangentSpace, str], Iterator[Input]]


def _joint_dofs(
    world: WorldCore, space: TangentSpace, *, driven: bool
) -> Iterator[tuple[BodyCore, int, int, str]]:
    """Bodies, rows of velocities, dofs and names of joints, or of those that a motor can drive."""
    for body, (first, _) in zip(space.bodies, space.places, strict=True):
        offset = first - (body.first_velocity if not body.fixed_base else body.first_velocity + 6)
        for joint, kind in enumerate(body.joint_types):
            if driven and kind not in DRIVEN:
                continue
            start = body.velocity_index[joint]
            for row in range(start, start + body.velocity_count[joint]):
                label, end = space.labels[row + offset]
                yield body, row, row + offset, f"{label}.{{}}{'.' + end if end else ''}"


def _of_dofs(field: str, *columns: int, driven: bool = False, impulse: bool = False) -> Finder:
    def find(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
        scale = world.parameters.substep_time if impulse else 1.0
        table = "model" if field in world.arrays.model.numpy else "state"
        for _, row, dof, name in _joint_dofs(world, space, driven=driven):
            yield Input(kind, name.format(ENDS[kind]), table, field, (row, *columns), scale, dof)

    return find


def _damping(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
    for body, row, dof, name in _joint_dofs(world, space, driven=False):
        field = "dof_" + body.spec.damping_field.removeprefix("dof_")
        yield Input(kind, name.format(ENDS[kind]), "model", field, (row,), 1.0, dof)


def _of_links(table: str, field: str, count: int = 0) -> Finder:
    def find(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
        for body in world.bodies.values():
            for link in range(BASE, body.joint_count):
                if table == "model" and ((link < 0 and body.fixed_base) or body not in space.bodies):
                    continue
                row = body.first_link + 1 + link
                part = "base" if link < 0 else body.spec.links[link].name
                name = f"{body_label(world, body)}.{part}.{ENDS[kind]}"
                for axis in range(max(count, 1)):
                    own = f"{name}.{_AXES[axis]}" if count else name
                    yield Input(kind, own, table, field, (row, axis) if count else (row,), 1.0, row)

    return find


def _friction(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
    """The lateral friction of links, which all of its shapes have."""
    shapes = world.contact_arrays.shapes
    for it in _of_links("shapes", "link_node_friction")(world, space, kind):
        rows = shapes.shapes_of(it.row)
        if rows.start < rows.stop:
            it = it._replace(
                field="shape_lateral_friction", place=(rows.start,), copies=rows.stop - rows.start
            )
        yield it


def _inertial(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
    for body in space.bodies:
        for link in range(BASE, body.joint_count):
            if link < 0 and body.fixed_base:
                continue
            row = body.first_link + 1 + link
            part = "base" if link < 0 else body.spec.links[link].name
            for place, number in enumerate(INERTIAL_NUMBERS):
                name = f"{body_label(world, body)}.{part}.{ENDS[kind]}.{number}"
                yield Input(kind, name, "model", "link_mass", (row, place), 1.0, row)


def _offsets(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
    for body in space.bodies:
        for link, spec in enumerate(body.spec.links):
            row = body.first_link + 1 + link
            for axis in range(3):
                name = f"{body_label(world, body)}.{spec.name}.{ENDS[kind]}.{_AXES[axis]}"
                yield Input(kind, name, "model", OFFSET_FIELD, (row, axis), 1.0, row)


def _of_actuators(table: str, field: str, count: int = 0) -> Finder:
    def find(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
        for body in space.bodies:
            for index, spec in enumerate(body.spec.actuators):
                row = body.rows.first["actuator"] + index
                name = f"{body_label(world, body)}.{spec.name}.{ENDS[kind]}"
                for term in range(max(count, 1)):
                    own = f"{name}.{term}" if count else name
                    yield Input(kind, own, table, field, (row, term) if count else (row,), 1.0, row)

    return find


def _joint_friction(world: WorldCore, space: TangentSpace, kind: str) -> Iterator[Input]:
    model = world.arrays.model.numpy
    names = {row: (dof, name) for _, row, dof, name in _joint_dofs(world, space, driven=True)}
    for constraint in range(world.arrays.used["constraint"]):
        if model["constraint_kind"][constraint] == ConstraintKind.FRICTION:
            dof, name = names[int(model["link_first_dof"][model["constraint_link"][constraint]])]
            yield Input(kind, name.format(ENDS[kind]), "model", "constraint_upper", (constraint,), 1.0, dof)


CONTROLS: dict[str, Finder] = {
    "torques": _of_dofs("dof_torque"),
    "target_positions": _of_dofs("dof_motor", MOTOR_POSITION, driven=True),
    "target_velocities": _of_dofs("dof_motor", MOTOR_VELOCITY, driven=True),
    "actuators": _of_actuators("state", "actuator_control"),
}
PARAMETERS: dict[str, Finder] = {
    "masses": _of_links("model", "link_mass"),
    "inertias": _of_links("model", "link_inertia", 3),
    INERTIAL: _inertial,
    OFFSETS: _offsets,
    "friction": _friction,
    "joint_friction": _joint_friction,
    "stiffness": _of_dofs("dof_stiffness"),
    "damping": _damping,
    "armature": _of_dofs("dof_armature"),
    "motor_position_gains": _of_dofs("dof_motor", MOTOR_KP, driven=True),
    "motor_velocity_gains": _of_dofs("dof_motor", MOTOR_KD, driven=True),
    "motor_forces": _of_dofs("dof_motor", MOTOR_MAX_IMPULSE, driven=True, impulse=True),
    "actuator_gains": _of_actuators("model", "actuator_gain", 3),
    "actuator_biases": _of_actuators("model", "actuator_bias", 3),
}
ENDS = {
    "torques": "torque",
    "target_positions": "target_position",
    "target_velocities": "target_velocity",
    "actuators": "control",
    "masses": "mass",
    "inertias": "inertia",
    INERTIAL: "inertial",
    OFFSETS: "offset",
    "friction": "friction",
    "joint_friction": "joint_friction",
    "stiffness": "stiffness",
    "damping": "damping",
    "armature": "armature",
    "motor_position_gains": "motor_position_gain",
    "motor_velocity_gains": "motor_velocity_gain",
    "motor_forces": "motor_force",
    "actuator_gains": "gain",
    "actuator_biases": "bias",
}


def chosen_inputs(
    world: WorldCore, space: TangentSpace, kinds: dict[str, Finder], chosen: Sequence[str], what: str
) -> list[Input]:
    """The inputs that are chosen by kind, such as "torques", or by their full names, in this order.

    Raises:
        ValueError: There is no such kind or input, or one is chosen twice.
    """
    found: list[Input] = []
    by_name: dict[str, Input] = {}
    for choice in [chosen] if isinstance(chosen, str) else chosen:
        if choice in kinds:
            found += kinds[choice](world, space, choice)
            continue
        if not by_name:
            by_name = {it.name: it for kind, find in kinds.items() for it in find(world, space, kind)}
        if choice not in by_name:
            near = get_close_matches(choice, [*kinds, *by_name], 1)
            hint = f"; did you mean {near[0]!r}?" if near else f": there are {', '.join(kinds)}"
            raise ValueError(f"there is no {what} {choice!r}{hint}")
        found.append(by_name[choice])
    names = [it.name for it in found]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise ValueError(f"{twice!r} is chosen twice, or two parts of a body have this name")
    return found
