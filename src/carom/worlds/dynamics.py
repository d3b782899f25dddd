"""Parameters of a body that differ between worlds, for domain randomisation."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.codes import ConstraintKind
from carom.model.body_spec import BASE
from carom.model.shape_arrays import SURFACE_FIELDS
from carom.scene.body import Body
from carom.scene.dynamics_changes import OF_BODY, shape_inertia, unit_inertia
from carom.worlds.chosen import Chosen

# Fields of `Shapes` that can differ between worlds, by their public names.
OF_SURFACE = {
    name: SURFACE_FIELDS[name]
    for name in (
        "lateral_friction",
        "rolling_friction",
        "spinning_friction",
        "restitution",
        "contact_stiffness",
        "contact_damping",
    )
}
LIMITS = {"joint_lower_limit": "constraint_lower", "joint_upper_limit": "constraint_upper"}
_ALL = ("mass", "inertia", *OF_SURFACE, *OF_BODY, "joint_damping", *LIMITS)
_NOT_NEGATIVE = ("mass", "inertia", "restitution", *OF_BODY, "joint_damping")


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
            np.asarray(engine.take(value)), _inner_shape(name), name, finite=name not in LIMITS
        )
        for name, value in changes.items()
    }
    for name in _NOT_NEGATIVE:
        if name in values and (values[name] < 0.0).any():
            raise ValueError(f"{name} must not be negative")
    _open_crossed_limits(engine, body, link, worlds, values)
    writes = list(_writes(engine, body, link, values))
    for table, field, rows, numbers in writes:
        engine.set_parameter(table, field, rows, numbers, worlds.rows)


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
    found = {name: engine.parameter("shapes", field, row) for name, field in OF_SURFACE.items()}
    found |= {name: engine.parameter("model", field, body.rows.tree) for name, field in OF_BODY.items()}
    if link != BASE or not body.fixed_base:
        found["mass"] = engine.parameter("model", "link_mass", row)
        found["inertia"] = engine.parameter("model", "link_inertia", row)
    if link != BASE and body.velocity_count[link]:
        found["joint_damping"] = engine.parameter("model", "dof_damping", body.velocity_index[link])
        limit = limit_rows(engine, body).get(link)
        if limit is not None:
            found |= {name: engine.parameter("model", field, limit) for name, field in LIMITS.items()}
    return {name: found[name] for name in _ALL if name in found}


def _inner_shape(name: str) -> tuple[int, ...]:
    """Shape of a parameter in one world."""
    return (3,) if name == "inertia" else ()


def _writes(
    engine: Engine, body: Body, link: int, values: Mapping[str, np.ndarray]
) -> Iterator[tuple[str, str, int | slice, np.ndarray]]:
    """The changes of arrays: table, field, rows, numbers (first axis: worlds)."""
    row, tree = body.first_link + 1 + link, body.rows.tree
    for name, numbers in values.items():
        if name in OF_SURFACE:
            yield "shapes", OF_SURFACE[name], row, numbers
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
        elif name == "joint_damping":
            _require_joint(link, name)
            first = body.velocity_index[link]
            dofs = slice(first, first + body.velocity_count[link])
            yield "model", "dof_damping", dofs, numbers[:, None]
        else:
            _require_joint(link, name)
            yield "model", LIMITS[name], _limit_row(engine, body, link), numbers


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


def limit_rows(engine: Engine, body: Body) -> dict[int, int]:
    """Rows among the constraints of the limits of a body's joints, by joint."""
    model, used = engine.arrays.model.numpy, engine.arrays.used["constraint"]
    first = body.first_link + 1
    links = model["constraint_link"][:used]
    is_own = (links >= first) & (links < first + body.joint_count)
    rows = np.flatnonzero(is_own & (model["constraint_kind"][:used] == ConstraintKind.LIMIT))
    # The first of several counts.
    return {int(links[row]) - first: int(row) for row in rows[::-1]}
