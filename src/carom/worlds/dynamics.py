"""Parameters of a body that differ between worlds, for domain randomisation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.codes import ConstraintKind
from carom.layouts.quick_world import OF_BODY, SURFACE
from carom.model.body_spec import BASE
from carom.model.link_dynamics import DIMENSIONS_NEEDED
from carom.scene.body import Body
from carom.scene.dynamics_changes import shape_inertia, unit_inertia
from carom.scene.joint_terms.implicit import OF_DOFS, SPRING_REFERENCE, TERMS
from carom.worlds.chosen import Chosen
from carom.worlds.writing import to_the_end

_QUATERNION = 4
_DIMENSIONS = "shape_friction_dimensions"
LIMITS = {"joint_lower_limit": "constraint_lower", "joint_upper_limit": "constraint_upper"}
FRICTION = "joint_friction"
_OF_JOINT = (*TERMS, FRICTION)
_ALL = ("mass", "inertia", *SURFACE, *OF_BODY, *_OF_JOINT, *LIMITS)
# Those that may be infinite, which then bound nothing.
_BOUNDS = (*LIMITS, "max_joint_velocity")
_NOT_NEGATIVE = ("mass", "inertia", "restitution", *OF_BODY, "joint_damping", *OF_DOFS, FRICTION)


def change_dynamics(
    engine: Engine, body: Body, link: int, worlds: Chosen, changes: Mapping[str, ArrayLike]
) -> None:
    """Perform `BodyBatch.change_dynamics`; nothing changes if an argument is wrong."""
    unknown = [name for name in changes if name not in _ALL]
    if unknown:
        raise TypeError(
            f"no parameter {unknown[0]!r} can differ between worlds; those that can are {', '.join(_ALL)}"
        )
    values = {
        name: worlds.values(
            np.asarray(engine.take(value)), _inner_shape(body, link, name), name, finite=name not in _BOUNDS
        )
        for name, value in changes.items()
    }
    for name in _NOT_NEGATIVE:
        if name in values and (values[name] < 0.0).any():
            raise ValueError(f"{name} must not be negative")
    _open_crossed_limits(engine, body, link, worlds, values)
    writes = list(_writes(engine, body, link, values))
    shapes = engine.contact_arrays.shapes.shapes_of(body.first_link + 1 + link)
    for row in range(shapes.start, shapes.stop):
        writes += with_dimensions(engine, row, values, worlds)

    def write() -> None:
        for table, field, rows, numbers in writes:
            engine.set_parameter(table, field, rows, numbers, worlds.rows)

    to_the_end(write)


def with_dimensions(
    engine: Engine, row: int, values: Mapping[str, np.ndarray], worlds: Chosen
) -> list[tuple[str, str, int | slice, np.ndarray]]:
    """The change of a shape's dimensions where they are too few for a coefficient of friction that is set.

    Args:
        engine: The engine of the worlds.
        row: The row of the shape.
        values: The coefficients (n,), by their names in `LinkDynamics`, among others.
        worlds: The n worlds.
    """
    present = engine.parameter("shapes", _DIMENSIONS, row)[worlds.rows]
    least = present.copy()
    for name, needed in DIMENSIONS_NEEDED.items():
        if name in values:
            least = np.where((present > 0) & (values[name] > 0.0), np.maximum(least, needed), least)
    return [] if (least == present).all() else [("shapes", _DIMENSIONS, row, least)]


def _open_crossed_limits(
    engine: Engine, body: Body, link: int, worlds: Chosen, values: dict[str, np.ndarray]
) -> None:
    """Remove the limits where the lower one is greater than the upper one, as in a single world."""
    if values.keys().isdisjoint(LIMITS):
        return
    _require_joint(link, next(name for name in LIMITS if name in values))
    row = _limit_row(engine, body, link)
    lower, upper = (
        values.get(name, engine.parameter("model", field, row)[worlds.rows]) for name, field in LIMITS.items()
    )
    crossed = lower > upper
    if crossed.any():
        values["joint_lower_limit"] = np.where(crossed, -np.inf, lower)
        values["joint_upper_limit"] = np.where(crossed, np.inf, upper)


def dynamics_of(engine: Engine, body: Body, link: int) -> dict[str, Array]:
    """See `BodyBatch.dynamics`."""
    row = body.first_link + 1 + link
    found = surface_of(engine, body, link)
    found |= {name: engine.parameter("model", field, body.rows.tree) for name, field in OF_BODY.items()}
    if link != BASE or not body.fixed_base:
        found["mass"] = engine.parameter("model", "link_mass", row)
        found["inertia"] = engine.parameter("model", "link_inertia", row)
    if link != BASE and body.velocity_count[link]:
        dof, position = body.velocity_index[link], body.position_index[link]
        fields = {"joint_damping": body.spec.damping_field, **OF_DOFS}
        found |= {name: engine.parameter("model", field, dof) for name, field in fields.items()}
        count = body.position_count[link]
        coordinates = position if count == 1 else slice(position, position + count)
        found[SPRING_REFERENCE] = engine.parameter("model", "position_spring", coordinates)
        friction = friction_rows(engine, body).get(link)
        if friction is not None:
            found[FRICTION] = engine.parameter("model", "constraint_upper", friction)
        limit = limit_rows(engine, body).get(link)
        if limit is not None:
            found |= {name: engine.parameter("model", field, limit) for name, field in LIMITS.items()}
    return {name: found[name] for name in _ALL if name in found}


def surface_of(engine: Engine, body: Body, link: int) -> dict[str, Array]:
    """The surface of a link, or of its first shape, in each world: (count,) by the names in `SURFACE`."""
    row, dynamics = body.first_link + 1 + link, body.dynamics(link)
    shapes = engine.contact_arrays.shapes.shapes_of(row)
    if shapes.start < shapes.stop:
        return {name: engine.parameter("shapes", field, shapes.start) for name, field in SURFACE.items()}
    found = {name: np.full(engine.arrays.world_count, getattr(dynamics, name)) for name in SURFACE}
    found["lateral_friction"] = engine.parameter("shapes", "link_node_friction", row)
    return found


def _inner_shape(body: Body, link: int, name: str) -> tuple[int, ...]:
    """Shape of a parameter in one world."""
    if name == SPRING_REFERENCE and link != BASE and body.position_count[link] > 1:
        return (body.position_count[link],)
    return (3,) if name == "inertia" else ()


def _writes(
    engine: Engine, body: Body, link: int, values: Mapping[str, np.ndarray]
) -> Iterator[tuple[str, str, int | slice, np.ndarray]]:
    """The changes of arrays: table, field, rows, numbers (first axis: worlds)."""
    row, tree = body.first_link + 1 + link, body.rows.tree
    for name, numbers in values.items():
        if name in SURFACE:
            if name == "lateral_friction":
                yield "shapes", "link_node_friction", row, numbers
            yield "shapes", SURFACE[name], engine.contact_arrays.shapes.shapes_of(row), numbers[:, None]
        elif name in OF_BODY:
            yield "model", OF_BODY[name], tree, numbers
        elif name == "mass":
            if link == BASE and body.fixed_base:
                raise ValueError("the base is fixed: it has no mass in any world")
            if not numbers.all():
                raise ValueError("mass must be greater than 0: a link is free in all worlds or in none")
            yield "model", "link_mass", row, numbers
            if "inertia" not in values:
                yield "model", "link_inertia", row, _scaled_inertias(body, link, numbers)
        elif name == "inertia":
            yield "model", "link_inertia", row, numbers
        elif name in _OF_JOINT:
            _require_joint(link, name)
            yield from _joint_writes(engine, body, link, name, numbers)
        else:
            _require_joint(link, name)
            yield "model", LIMITS[name], _limit_row(engine, body, link), numbers


def _joint_writes(
    engine: Engine, body: Body, joint: int, name: str, numbers: np.ndarray
) -> Iterator[tuple[str, str, int | slice, np.ndarray]]:
    """As `_writes`, for damping, armature, spring or friction of a joint."""
    if name == FRICTION:
        yield "model", "constraint_upper", _friction_row(engine, body, joint), numbers
        return
    if name == SPRING_REFERENCE:
        first, count = body.position_index[joint], body.position_count[joint]
        if count == _QUATERNION:
            numbers = _units(numbers)
        yield "model", "position_spring", slice(first, first + count), numbers.reshape(len(numbers), -1)
        return
    first, count = body.velocity_index[joint], body.velocity_count[joint]
    field = OF_DOFS.get(name, body.spec.damping_field)
    yield "model", field, slice(first, first + count), numbers[:, None]
    if field != "dof_damping":
        # It stays on where all terms of a body are set to 0: sums with them are the same.
        yield "model", "tree_joint_terms", body.rows.tree, np.ones(len(numbers))


def _units(quaternions: np.ndarray) -> np.ndarray:
    sizes = np.sqrt((quaternions * quaternions).sum(axis=1, keepdims=True))
    if not sizes.all():
        raise ValueError(f"{SPRING_REFERENCE} must be a quaternion other than 0")
    return quaternions / sizes


def _scaled_inertias(body: Body, link: int, masses: np.ndarray) -> np.ndarray:
    """Inertias (n, 3) of a link of the original world with other masses (n,).

    They depend on nothing that was set before, so that an episode does not depend on earlier ones.
    """
    unit = unit_inertia(body, link)
    if unit is None:
        # The moments of shapes are in proportion to the mass as well.
        unit = shape_inertia(body, link, 1.0)
    return masses[:, None] * np.array(unit)


def _require_joint(link: int, name: str) -> None:
    if link == BASE:
        raise ValueError(f"the base has no joint, and no {name}")


def _limit_row(engine: Engine, body: Body, joint: int) -> int:
    """Row of a joint's limit among the constraints."""
    row = limit_rows(engine, body).get(joint)
    if row is None:
        name = body.spec.links[joint].joint_name
        raise ValueError(f"joint {name!r} has no limits: set them in the original world before it is copied")
    return row


def _friction_row(engine: Engine, body: Body, joint: int) -> int:
    """Row of a joint's friction among the constraints."""
    row = friction_rows(engine, body).get(joint)
    if row is None:
        name = body.spec.links[joint].joint_name
        raise ValueError(
            f"joint {name!r} has no friction: set friction_loss in the original world before it is copied"
        )
    return row


def limit_rows(engine: Engine, body: Body) -> dict[int, int]:
    """Rows among the constraints of the limits of a body's joints, by joint."""
    return _constraint_rows(engine, body, ConstraintKind.LIMIT)


def friction_rows(engine: Engine, body: Body) -> dict[int, int]:
    """Rows among the constraints of the friction of a body's joints, by joint."""
    return _constraint_rows(engine, body, ConstraintKind.FRICTION)


def _constraint_rows(engine: Engine, body: Body, kind: ConstraintKind) -> dict[int, int]:
    """Rows of the constraints of a kind on a body's joints, by joint."""
    model, used = engine.arrays.model.numpy, engine.arrays.used["constraint"]
    first = body.first_link + 1
    links = model["constraint_link"][:used]
    is_own = (links >= first) & (links < first + body.joint_count)
    rows = np.flatnonzero(is_own & (model["constraint_kind"][:used] == kind))
    # The first of several counts.
    return {int(links[row]) - first: int(row) for row in rows[::-1]}
