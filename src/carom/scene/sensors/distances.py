"""What sensors of distance show: how far apart two sets of shapes are, in which direction, and where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorKind, SensorSpec
from carom.errors import DescriptionError
from carom.scene.sensors.contacts import Side, sides
from carom.scene.sensors.source import Source

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def check_distance(bodies: Mapping[int, BodyCore], body: BodyCore, spec: SensorSpec) -> None:
    """Raise `DescriptionError` unless both sides of a sensor of distance exist and share no shape."""
    first, second = _both(bodies, body, spec)
    either = -1 in (first.shape, second.shape)
    if {*first.rows} & {*second.rows} and (either or first.shape == second.shape):
        raise DescriptionError(f"sensor {spec.name!r}: both sides have a shape in common")


def distances(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    """What a sensor of distance shows in each world, (worlds, dim)."""
    first, second = (_shapes(source, side) for side in _both(source.bodies, body, spec))
    found = source.nearest(first, second, spec.reach)
    if spec.kind is SensorKind.DISTANCE:
        return np.where(found.found, found.distances, spec.reach)
    if spec.kind is SensorKind.DISTANCE_NORMAL:
        # From one point to the other: where shapes overlap that is against the first side's way to the other.
        shown = np.where(found.distances < 0.0, 1.0, -1.0)[:, None] * found.normals
    else:
        shown = np.concatenate([found.on_first, found.on_second], axis=1)
    return np.where(found.found[:, None], shown, 0.0)


def _both(bodies: Mapping[int, BodyCore], body: BodyCore, spec: SensorSpec) -> tuple[Side, Side]:
    first, second = sides(bodies, body, spec)
    if first is None or second is None:
        raise DescriptionError(f"sensor {spec.name!r} needs two sides")
    return first, second


def _shapes(source: Source, side: Side) -> list[int]:
    """Rows of the shapes of a side."""
    arrays = source.engine.contact_arrays.shapes
    return [
        row
        for link in side.rows
        for number, row in arrays.rows_of_collisions(link)
        if side.shape in (-1, number)
    ]
