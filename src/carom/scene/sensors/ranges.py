"""What range finders see: along one ray, or along one through each pixel of an image."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import RangeImage, SensorSpec
from carom.scene.sensors.frames import object_frame, placement
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import turned

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_MISSED = -1.0


def ranges(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    """What a range finder shows in each world, (worlds, rays, numbers of a ray); see `RANGE_FIELDS`."""
    frame = object_frame(body, spec)
    start, turn = placement(source, frame)
    offsets, directions, cosines = rays_of(spec.image)
    count = len(directions)
    turns = np.repeat(np.broadcast_to(turn, (len(start), 4)), count, axis=0)
    local = np.tile(np.stack([offsets, directions], axis=1), (len(start), 1, 1))
    shape = (len(start), count, 3)
    along = turned(turns, local[:, 1]).reshape(shape)
    starts = start[:, None]
    if offsets.any():
        starts = starts + turned(turns, local[:, 0]).reshape(shape)
    starts = np.broadcast_to(starts, shape)
    ends = starts + spec.reach * along
    fraction, bodies, links, normals = source.hits(starts, ends, 0)
    own = (bodies == body.id) & (links == frame.link)
    if own.any():
        further, others, _, other_normals = source.hits(starts, ends, 1)
        fraction, bodies = np.where(own, further, fraction), np.where(own, others, bodies)
        normals = np.where(own[..., None], other_normals, normals)
    hit = bodies >= 0
    distance = fraction * spec.reach
    columns = {
        "dist": np.where(hit, distance, _MISSED)[..., None],
        "dir": np.where(hit[..., None], along, 0.0),
        "origin": starts,
        "point": np.where(hit[..., None], starts + distance[..., None] * along, 0.0),
        "normal": np.where(hit[..., None], normals, 0.0),
        "depth": np.where(hit, distance * cosines, _MISSED)[..., None],
    }
    return np.concatenate([columns[name] for name in spec.shows], axis=-1)


@lru_cache(64)
def rays_of(image: RangeImage | None) -> tuple[Array, Array, Array]:
    """Rays in the axes of the site: (n, 3) starts and directions, and (n,) cosines to the optical axis.

    Without an image there is one, along z. Those of an image go row by row, from its top left corner, and it
    looks along -z with y up.
    """
    if image is None:
        return np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]]), np.ones(1)
    (fx, fy), (middle_x, middle_y) = image.focal, image.middle
    across = ((np.arange(image.width) + 0.5) / image.width - middle_x) / fx
    down = ((np.arange(image.height) + 0.5) / image.height - middle_y) / fy
    x, y = (part.reshape(-1) for part in np.meshgrid(across, -down))
    zeros, ones = np.zeros_like(x), np.ones_like(x)
    if image.is_orthographic:
        return np.stack([x, y, zeros], axis=1), np.stack([zeros, zeros, -ones], axis=1), ones
    length = np.sqrt(x * x + y * y + 1.0)
    return np.zeros((len(x), 3)), np.stack([x, y, -ones], axis=1) / length[:, None], 1.0 / length
