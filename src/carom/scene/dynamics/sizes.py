"""Sizes of collision shapes: what users set, and all that follows from it for a link.

Bounds, margins, breaking distances and the place of a shape in the tree of its compound depend on sizes. They
are written by what writes them when a body is loaded (`ShapeArrays.replace_pieces`), so a body whose sizes
were set is one that was loaded with them. Masses and inertias stay as they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.geometry import MAX_SIZE, Geometry
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BASE, BodySpec, LinkSpec
from carom.model.inertia import collision_margin
from carom.native.change import Change

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.scene.core.body_core import BodyCore

OF_SHAPES = ("shape_size", "shape_margin", "shape_breaking", "shape_path")
"""The fields of `Shapes` that sizes of shapes determine, one row for each shape."""
OF_LINKS = ("link_center", "link_extents")
"""Those with one row for each link."""


def sides_from(value: Array, name: str = "size") -> Array:
    """Check lengths of sides [m], (..., 3), and return them.

    Raises:
        ValueError: One is not greater than 0, or greater than `MAX_SIZE`.
    """
    if not (value > 0.0).all():
        raise ValueError(f"{name} must be greater than 0 m along each axis")
    if not (value <= MAX_SIZE).all():
        raise ValueError(f"{name} must be at most {MAX_SIZE:g} m along each axis")
    return value


def with_geometries(spec: LinkSpec, geometries: Sequence[Geometry]) -> LinkSpec:
    """A link whose collision shapes are others, and so are the visible ones that show the same shapes."""
    others = {
        (own.geometry, own.frame): geometry
        for own, geometry in zip(spec.collisions, geometries, strict=True)
        if own.geometry != geometry
    }
    return replace(
        spec,
        collisions=tuple(
            replace(own, geometry=geometry) for own, geometry in zip(spec.collisions, geometries, strict=True)
        ),
        visuals=tuple(
            replace(it, geometry=others[it.geometry, it.frame]) if (it.geometry, it.frame) in others else it
            for it in spec.visuals
        )
        if others
        else spec.visuals,
    )


def note_pieces(change: Change, body: BodyCore, link: int, spec: LinkSpec) -> float:
    """Note a change of the shapes of a link to those of `spec`; returns the margin that it has then [m].

    A margin that was set for the link stays.

    Raises:
        ValueError: The shapes of other sizes would need other rows.
    """
    shapes = body.world.contact_arrays.shapes
    row = body.first_link + 1 + link
    present, own = body.dynamics(link).collision_margin, collision_margin(body.link_spec(link))
    implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
    shapes.replace_pieces(change, row, spec, implicit_cylinder=implicit)
    if present == own:
        return collision_margin(spec)
    shapes.note_surface(change, row, {"collision_margin": present})
    return present


def note_sizes(
    change: Change, body: BodyCore, link: int, geometries: Sequence[Geometry], *, keep_contacts: bool = False
) -> LinkSpec:
    """Note a change of the shapes of a link of a lone world; returns what its specification is then.

    Contacts are dropped, and detected again at the next step, unless they are those of the new shapes.

    Raises:
        ValueError: The shapes of other sizes would need other rows.
    """
    world = body.world
    spec = with_geometries(body.link_spec(link), geometries)
    margin = note_pieces(change, body, link, spec)
    rows = world.contact_arrays.shapes.body_of(body.rows)
    change.set(rows, "resizes", rows.resizes + 1)
    change.set(body, "spec", with_link(body.spec, link, spec))
    change.set(body, "derived", {})
    change.set(body.dynamics(link), "collision_margin", margin)
    if not keep_contacts:
        world.contact_arrays.drop_contacts(change)
    world.change_scene(change)
    return spec


def with_link(spec: BodySpec, link: int, own: LinkSpec) -> BodySpec:
    """A body with another link."""
    if link == BASE:
        return replace(spec, base=own)
    links = list(spec.links)
    links[link] = own
    return replace(spec, links=links)


def rows_with(
    body: BodyCore, link: int, several: Sequence[Sequence[Geometry]]
) -> dict[str, NDArray[np.floating]]:
    """What `Shapes` have of a link with each of k lists of geometries, by field; nothing is changed.

    Raises:
        ValueError: The shapes of other sizes would need other rows.
    """
    table = body.world.contact_arrays.shapes.table.numpy
    row = body.first_link + 1 + link
    shapes = body.world.contact_arrays.shapes.shapes_of(row)
    places: dict[str, int | slice] = {**dict.fromkeys(OF_SHAPES, shapes), **dict.fromkeys(OF_LINKS, row)}
    found = {
        name: np.empty((len(several), *table[name][0, place].shape), table[name].dtype)
        for name, place in places.items()
    }
    # Never made: its copies of the arrays have what it would write.
    change = Change()
    for number, geometries in enumerate(several):
        note_pieces(change, body, link, with_geometries(body.link_spec(link), geometries))
        written = change.arrays(table)
        for name, place in places.items():
            found[name][number] = written[name][0, place]
    return found
