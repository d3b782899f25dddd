"""Parameters of a body that differ between worlds, for domain randomisation."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.dynamics_parameters import LIMITS, LINK, PARAMETERS, SHAPE, SURFACE, VELOCITY
from carom.model.body_spec import BASE
from carom.model.link_dynamics import DIMENSIONS_NEEDED
from carom.scene.body import Body
from carom.scene.dynamics.inertia import shape_inertia, unit_inertia
from carom.scene.dynamics.places import Place, places, view, write
from carom.scene.joint_terms.implicit import DAMPING, SPRING_REFERENCE
from carom.worlds.chosen import Chosen
from carom.worlds.writing import to_the_end

_QUATERNION = 4
_DIMENSIONS = "shape_friction_dimensions"
_VARYING = {name: row for name, row in PARAMETERS.items() if row.varies}


def change_dynamics(
    engine: Engine, body: Body, link: int, worlds: Chosen, changes: Mapping[str, ArrayLike]
) -> None:
    """Perform `BodyBatch.change_dynamics`; nothing changes if an argument is wrong."""
    unknown = [name for name in changes if name not in _VARYING]
    if unknown:
        raise TypeError(
            f"no parameter {unknown[0]!r} can differ between worlds; those that can are {', '.join(_VARYING)}"
        )
    values: dict[str, np.ndarray] = {}
    for name, value in changes.items():
        known = _VARYING[name]
        numbers = np.asarray(engine.take(value))
        shape = _inner_shape(body, link, name)
        values[name] = worlds.values(numbers, shape, name, finite=not known.unbounded)
        if known.not_negative and (values[name] < 0.0).any():
            raise ValueError(f"{name} must not be negative")
    _open_crossed_limits(engine, body, link, worlds, values)
    _check_masses(body, link, values)
    writes = [
        (place, numbers) for name, numbers in values.items() for place in _places(engine, body, link, name)
    ]
    writes += _joint_terms_used(body, values)
    shapes = engine.contact_arrays.shapes.shapes_of(body.first_link + 1 + link)
    for row in range(shapes.start, shapes.stop):
        writes += with_dimensions(engine, row, values, worlds)

    def write_all() -> None:
        for place, numbers in writes:
            write(engine, place, numbers, worlds.rows)

    to_the_end(write_all)


def with_dimensions(
    engine: Engine, row: int, values: Mapping[str, np.ndarray], worlds: Chosen
) -> list[tuple[Place, np.ndarray]]:
    """The change of a shape's dimensions where they are too few for a coefficient of friction that is set.

    Args:
        engine: The engine of the worlds.
        row: The row of the shape.
        values: The coefficients (n,), by their names in `LinkDynamics`, among others.
        worlds: The n worlds.
    """
    place = ("shapes", _DIMENSIONS, row)
    if values.keys().isdisjoint(DIMENSIONS_NEEDED) or not view(engine, place).any():
        return []
    present = engine.parameter(*place)[worlds.rows]
    least = present.copy()
    for name, needed in DIMENSIONS_NEEDED.items():
        if name in values:
            least = np.where((present > 0) & (values[name] > 0.0), np.maximum(least, needed), least)
    return [] if (least == present).all() else [(place, least)]


def _open_crossed_limits(
    engine: Engine, body: Body, link: int, worlds: Chosen, values: dict[str, np.ndarray]
) -> None:
    """Remove the limits where the lower one is greater than the upper one, as in a single world."""
    if values.keys().isdisjoint(LIMITS):
        return
    lower, upper = (
        values[name] if name in values else _read(engine, _places(engine, body, link, name)[0])[worlds.rows]
        for name in LIMITS
    )
    crossed = lower > upper
    if crossed.any():
        values["joint_lower_limit"] = np.where(crossed, -np.inf, lower)
        values["joint_upper_limit"] = np.where(crossed, np.inf, upper)


def dynamics_of(engine: Engine, body: Body, link: int) -> dict[str, Array]:
    """See `BodyBatch.dynamics`."""
    surface = surface_of(engine, body, link)
    found: dict[str, Array] = {}
    for name, row in _VARYING.items():
        if row.owner == SHAPE:
            found[name] = surface[name]
        elif row.owner != LINK or link != BASE or not body.fixed_base:
            for place in places(engine, body, link, name):
                found[name] = _read(engine, place)
    return found


def _read(engine: Engine, place: Place) -> Array:
    """A parameter in each world, (count, ...): of several rows with the same number, the first."""
    table, field, rows = place
    if isinstance(rows, slice) and (field != "position_spring" or rows.stop - rows.start == 1):
        rows = rows.start
    return engine.parameter(table, field, rows)


def surface_of(engine: Engine, body: Body, link: int) -> dict[str, Array]:
    """The surface of a link, or of its first shape, in each world: (count,) by the names in `SURFACE`."""
    shapes = engine.contact_arrays.shapes.shapes_of(body.first_link + 1 + link)
    if shapes.start < shapes.stop:
        return {name: engine.parameter("shapes", field, shapes.start) for name, field in SURFACE.items()}
    # Without shapes only what nodes of soft bodies meet differs between worlds.
    return {
        name: _read(engine, kept[0])
        if (kept := places(engine, body, link, name))
        else np.full(engine.arrays.world_count, getattr(body.dynamics(link), name))
        for name in SURFACE
    }


def _inner_shape(body: Body, link: int, name: str) -> tuple[int, ...]:
    """Shape of a parameter in one world."""
    if name == SPRING_REFERENCE and link != BASE and body.position_count[link] > 1:
        return (body.position_count[link],)
    return (3,) if name == "inertia" else ()


def _places(engine: Engine, body: Body, link: int, name: str) -> list[Place]:
    """Where a parameter is kept, which the link must have."""
    kept = places(engine, body, link, name)
    if kept or PARAMETERS[name].owner == SHAPE:
        return kept
    if link == BASE:
        raise ValueError(f"the base has no joint, and no {name}")
    joint = f"joint {body.spec.links[link].joint_name!r}"
    if name in LIMITS:
        raise ValueError(f"{joint} has no limits: set them in the original world before it is copied")
    if name == "joint_friction":
        raise ValueError(
            f"{joint} has no friction: set friction_loss in the original world before it is copied"
        )
    return kept


def _check_masses(body: Body, link: int, values: dict[str, np.ndarray]) -> None:
    """Check masses, add the inertia that a link has with them, and make references of balls quaternions."""
    masses = values.get("mass")
    if masses is not None:
        if link == BASE and body.fixed_base:
            raise ValueError("the base is fixed: it has no mass in any world")
        if not masses.all():
            raise ValueError("mass must be greater than 0: a link is free in all worlds or in none")
        if "inertia" not in values:
            values["inertia"] = _scaled_inertias(body, link, masses)
    rest = values.get(SPRING_REFERENCE)
    if rest is not None and rest.shape[1:] == (_QUATERNION,):
        values[SPRING_REFERENCE] = _units(rest)


def _joint_terms_used(body: Body, values: Mapping[str, np.ndarray]) -> list[tuple[Place, np.ndarray]]:
    """The note that a body has joint terms, where some are set that are no damping of the drop-in.

    It stays on where all terms of a body are set to 0: sums with them are the same.
    """
    used = [numbers for name, numbers in values.items() if _is_implicit(body, name)]
    return [(("model", "tree_joint_terms", body.rows.tree), np.ones(len(used[0])))] if used else []


def _is_implicit(body: Body, name: str) -> bool:
    return PARAMETERS[name].owner == VELOCITY and (
        name != DAMPING or body.spec.damping_field != "dof_damping"
    )


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
