"""Where the parameters of links, joints and bodies are kept, and writing them there.

`carom.layouts.dynamics_parameters` lists them. One world and many worlds write to the same places, the former
with a change.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from carom.layouts.codes import ConstraintKind
from carom.layouts.dynamics_parameters import BODY, LIMIT, LINK, PARAMETERS, POSITION, SHAPE, VELOCITY

if TYPE_CHECKING:
    from carom.engine.contact_arrays import ContactArrays
    from carom.engine.world_parameters import WorldParameters
    from carom.model.body_rows import TreeRows
    from carom.model.body_spec import BodySpec, LinkSpec
    from carom.model.builder import WorldArrays
    from carom.model.link_dynamics import LinkDynamics
    from carom.native.change import Change

Place = tuple[str, str, "int | slice"]
"""A table, "model" or "shapes", a field of it, and its rows."""


class Tables(Protocol):
    """A world, or the engine of several worlds."""

    arrays: WorldArrays
    contact_arrays: ContactArrays


class Parts(Protocol):
    """What of a body says where its parameters are, and what they are."""

    spec: BodySpec
    rows: TreeRows
    velocity_index: tuple[int, ...]
    velocity_count: tuple[int, ...]
    position_index: tuple[int, ...]
    position_count: tuple[int, ...]

    @property
    def first_link(self) -> int:
        """Row of its base."""
        ...

    @property
    def joint_count(self) -> int:
        """Number of its joints."""
        ...

    def dynamics(self, link: int) -> LinkDynamics:
        """Present parameters of a link."""
        ...

    def link_spec(self, link: int) -> LinkSpec:
        """What its file says of a link."""
        ...


def places(tables: Tables, body: Parts, link: int, name: str) -> list[Place]:
    """Where a parameter of a link, its joint or its body is kept; nowhere if it has none.

    Args:
        tables: A world with the body, or the engine of copies of it.
        body: The body.
        link: The link; -1 is the base.
        name: One of `PARAMETERS` with a field, or `joint_damping`.
    """
    known = PARAMETERS[name]
    owner, field = known.owner, known.field
    if owner == SHAPE:
        row = body.first_link + 1 + link
        return [("shapes", *place) for place in tables.contact_arrays.shapes.surface_places(name, row)]
    if owner == BODY:
        return [("model", field, body.rows.tree)]
    if owner == LINK:
        return [("model", field, body.first_link + 1 + link)]
    if link < 0:
        return []
    if owner == VELOCITY:
        first, count = body.velocity_index[link], body.velocity_count[link]
        return [("model", field or body.spec.damping_field, slice(first, first + count))] if count else []
    if owner == POSITION:
        first, count = body.position_index[link], body.position_count[link]
        return [("model", field, slice(first, first + count))] if count else []
    kind = ConstraintKind.LIMIT if owner == LIMIT else ConstraintKind.FRICTION
    model, used = tables.arrays.model.numpy, tables.arrays.used["constraint"]
    is_own = model["constraint_link"][:used] == body.first_link + 1 + link
    rows = np.flatnonzero(is_own & (model["constraint_kind"][:used] == kind))
    # The first of several counts.
    return [("model", field, int(rows[0]))] if len(rows) else []


def limit_rows(tables: Tables, body: Parts) -> dict[int, int]:
    """Rows among the constraints of the limits of a body's joints, by joint."""
    model, used = tables.arrays.model.numpy, tables.arrays.used["constraint"]
    first = body.first_link + 1
    links = model["constraint_link"][:used]
    is_own = (links >= first) & (links < first + body.joint_count)
    rows = np.flatnonzero(is_own & (model["constraint_kind"][:used] == ConstraintKind.LIMIT))
    # The first of several counts.
    return {int(links[row]) - first: int(row) for row in rows[::-1]}


def view(tables: Tables, place: Place) -> np.ndarray:
    """The array at a place: for each world, or one that all share."""
    name, field, rows = place
    table = tables.arrays.model if name == "model" else tables.contact_arrays.shapes.table
    if table.is_per_world(field):
        return table.numpy[field][:, rows]
    return table.numpy[field][slice(rows, rows + 1) if isinstance(rows, int) else rows]


def note(change: Change, tables: Tables, body: Parts, link: int, name: str, value: Any) -> None:
    """Write a parameter of a link of a lone world with a change."""
    for place in places(tables, body, link, name):
        change.write(view(tables, place), value)


def write(engine: WorldParameters, place: Place, numbers: np.ndarray, worlds: slice | np.ndarray) -> None:
    """Write numbers of n worlds to a place: (n,), the same to all its rows, or (n, ...)."""
    table, field, rows = place
    is_one = isinstance(rows, slice) and numbers.ndim == 1
    engine.set_parameter(table, field, rows, numbers[:, None] if is_one else numbers, worlds)
