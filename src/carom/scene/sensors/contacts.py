"""What sensors of contacts show: those of the last step between two sets of shapes, or at a site."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.description.sensor import ContactReduction, SensorObject, SensorSpec
from carom.description.site import SiteShape, SiteSpec
from carom.errors import DescriptionError
from carom.layouts.contacts import THERE
from carom.scene.sensors.frames import frame_of, object_frame, placement, reference_body
from carom.scene.sensors.source import Source
from carom.scene.sensors.subtrees import subtree_rows
from carom.scene.sensors.vectors import cross, dot, turned_back

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_TINY = 1e-15


class Side(NamedTuple):
    """Shapes of some links.

    Attributes:
        rows: Rows of the links.
        shape: Which collision shape of the link counts, if there is one; all if it is negative.
    """

    rows: list[int]
    shape: int


class _Found(NamedTuple):
    """Contacts that count, (n, ...): their worlds, and what is seen of them from the first side."""

    worlds: np.ndarray
    points: Array
    normals: Array
    distances: Array
    forces: Array


def sides(
    bodies: Mapping[int, BodyCore], body: BodyCore, spec: SensorSpec
) -> tuple[Side | None, Side | None]:
    """The two sides of a sensor of contacts: its object, and what it touches; None for anything.

    Raises:
        DescriptionError: There is no such body, site, shape or link.
    """
    first = None
    if spec.object_type is SensorObject.SITE:
        object_frame(body, spec)
    else:
        first = _side(body, spec)
    if spec.reference_type is SensorObject.NONE:
        return first, None
    other = reference_body(bodies, body, spec)
    return first, _side(other, replace(spec, object_type=spec.reference_type, object=spec.reference))


def _side(body: BodyCore, spec: SensorSpec) -> Side:
    if spec.object_type is SensorObject.SHAPE:
        for link, part in enumerate((body.spec.base, *body.spec.links)):
            for number, collision in enumerate(part.collisions):
                if collision.name == spec.object:
                    return Side([body.first_link + link], number)
        raise DescriptionError(
            f"sensor {spec.name!r}: body {body.name!r} has no collision shape {spec.object!r}"
        )
    if spec.object_type is SensorObject.SUBTREE:
        return Side(subtree_rows(body, spec), -1)
    return Side([frame_of(body, SensorObject.LINK, spec.object).row], -1)


def contacts(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    """What a sensor of contacts shows in each world, (worlds, dim)."""
    found = _found(source, body, spec)
    counts = np.bincount(found.worlds, minlength=source.count)
    shown = np.zeros((source.count, spec.slots, spec.dim // spec.slots))
    if not len(found.worlds):
        return shown.reshape(source.count, -1)
    if spec.reduction is ContactReduction.NET_FORCE:
        worlds, slots, columns = np.flatnonzero(counts), 0, _net(found, source.count)
        columns = {name: values[worlds] for name, values in columns.items()}
    else:
        order = np.arange(len(found.worlds))
        if spec.reduction is ContactReduction.NEAREST:
            order = np.lexsort((found.distances, found.worlds))
        elif spec.reduction is ContactReduction.STRONGEST:
            order = np.lexsort((-np.linalg.norm(found.forces, axis=1), found.worlds))
        # Contacts are sorted by world, and each world begins with its slot 0.
        slots = np.arange(len(order)) - (np.cumsum(counts) - counts)[found.worlds[order]]
        order, slots = order[slots < spec.slots], slots[slots < spec.slots]
        worlds, columns = found.worlds[order], _single(_Found(*(it[order] for it in found)))
    columns["found"] = counts[worlds][:, None].astype(float)
    shown[worlds, slots] = np.concatenate([columns[name] for name in spec.fields], axis=1)
    return shown.reshape(source.count, -1)


def _found(source: Source, body: BodyCore, spec: SensorSpec) -> _Found:
    first, second = sides(source.bodies, body, spec)
    number = source.contacts("count_contacts")[:, THERE]
    most = int(number.max(initial=0))
    shapes = source.contacts("contact_shapes")[:, :most]
    impulses = source.contacts("contact_impulse")[:, :most]
    distances = source.contacts("contact_distance")[:, :most]
    # Those of side a, then those of side b, seen from the first side of the sensor.
    on_a = _is_of(source, shapes[..., 0], first) & _is_of(source, shapes[..., 1], second)
    on_b = _is_of(source, shapes[..., 1], first) & _is_of(source, shapes[..., 0], second)
    there = (np.arange(most)[None] < number[:, None]) & ((impulses[..., 0] > 0.0) | (distances <= 0.0))
    worlds, rows = np.nonzero(there & (on_a | on_b))
    # Normals point from b to a.
    sign = np.where(on_a[worlds, rows], -1.0, 1.0)[:, None]
    if spec.is_reversed:
        sign = -sign

    def of(name: str) -> Array:
        return np.asarray(source.contacts(f"contact_{name}")[worlds, rows])

    impulse = of("impulse")
    on_side_a = (
        impulse[:, :1] * of("normal") + impulse[:, 1:2] * of("direction1") + impulse[:, 2:] * of("direction2")
    )
    found = _Found(
        worlds,
        0.5 * (of("point_a") + of("point_b")),
        sign * of("normal"),
        of("distance"),
        sign * on_side_a / source.parameters.substep_time,
    )
    if spec.object_type is not SensorObject.SITE:
        return found
    site = next(site for site in body.spec.sites if site.name == spec.object)
    place = placement(source, object_frame(body, spec))
    at = turned_back(place.orientation[worlds], found.points - place.position[worlds])
    inside = _is_inside(site, at)
    return _Found(*(it[inside] for it in found))


def _is_of(source: Source, shapes: np.ndarray, side: Side | None) -> np.ndarray:
    """Whether shapes, by row, are of a side."""
    if side is None:
        return np.ones(shapes.shape, dtype=bool)
    arrays = source.engine.contact_arrays.shapes
    is_of = np.zeros(len(arrays.table.numpy["shape_link"]), dtype=bool)
    for link in side.rows:
        for number, row in arrays.rows_of_collisions(link):
            is_of[row] |= side.shape in (-1, number)
    return np.asarray(is_of[shapes])


def _is_inside(site: SiteSpec, points: Array) -> np.ndarray:
    """Whether points (n, 3) in the frame of a site are in its volume, (n,)."""
    size = np.array(site.size)
    if site.shape is SiteShape.SPHERE:
        return np.asarray(dot(points, points) <= size[0] ** 2)
    if site.shape is SiteShape.ELLIPSOID:
        return np.asarray(
            (points**2 * (size[[1, 2, 0]] * size[[2, 0, 1]]) ** 2).sum(axis=1) <= size.prod() ** 2
        )
    if site.shape is SiteShape.BOX:
        return np.asarray((np.abs(points) <= size).all(axis=1))
    beyond = np.maximum(np.abs(points[:, 2]) - size[1], 0.0)
    if site.shape is SiteShape.CAPSULE:
        return np.asarray(points[:, 0] ** 2 + points[:, 1] ** 2 + beyond**2 <= size[0] ** 2)
    return np.asarray((points[:, 0] ** 2 + points[:, 1] ** 2 <= size[0] ** 2) & (beyond == 0.0))


def _single(found: _Found) -> dict[str, Array]:
    """What is shown of each contact, (n, numbers) by name."""
    normals = found.normals
    # Across the normal, as near to y as it can be, or to z where the normal is near to y.
    guide = np.where((np.abs(normals[:, 1:2]) < 0.5), [[0.0, 1.0, 0.0]], [[0.0, 0.0, 1.0]])
    tangents = guide - dot(guide, normals)[:, None] * normals
    tangents /= np.linalg.norm(tangents, axis=1, keepdims=True)
    axes = (normals, tangents, cross(normals, tangents))
    return {
        "force": np.stack([dot(found.forces, axis) for axis in axes], axis=1),
        "torque": np.zeros_like(found.points),
        "dist": found.distances[:, None],
        "pos": found.points,
        "normal": normals,
        "tangent": tangents,
    }


def _net(found: _Found, count: int) -> dict[str, Array]:
    """The same of one contact in each of `count` worlds that stands for all, in world axes."""

    def total(values: Array) -> Array:
        columns = [np.bincount(found.worlds, weights=it, minlength=count) for it in values.T]
        return np.stack(columns, axis=1).astype(float)

    weights = np.linalg.norm(found.forces, axis=1, keepdims=True)
    middle = total(weights * found.points) / np.maximum(total(weights), _TINY)
    moments = cross(found.points - middle[found.worlds], found.forces)
    unit = np.tile(np.eye(3), (count, 1, 1))
    return {
        "force": total(found.forces),
        "torque": total(moments),
        "dist": np.zeros((count, 1)),
        "pos": middle,
        "normal": unit[:, 0],
        "tangent": unit[:, 1],
    }
