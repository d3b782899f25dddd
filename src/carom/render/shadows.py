"""The camera at the light, for shadow mapping."""

from __future__ import annotations

from math import isinf

import numpy as np

from carom.native.products import product
from carom.record import record
from carom.render.lights import Light
from carom.render.projection import Matrix, look_along, look_at, parallel_projection, unit_vector
from carom.render.scene import SceneArrays

PARALLEL_MAP_SIDE = 1024
"""Width and height of the shadow map of parallel light [pixels]."""

LARGEST_CASTER = 50.0
"""Bounding radius above which a shape, such as a floor, casts no shadow in parallel light [m]."""

# Shadow bias: a surface this far behind the nearest one is still lit, or it would shade itself.
_LAMP_BIAS = 0.05
"""Of a lamp [m]."""
_PARALLEL_BIAS = 3.0
"""Of parallel light [pixels of the shadow map]."""


@record(eq=False)
class ShadowCamera:
    """A camera at the light; its depth buffer is the shadow map.

    Attributes:
        view: (4, 4) world to eye coordinates.
        projection: (4, 4) eye to clip coordinates.
        width: Columns of the shadow map.
        height: Rows of the shadow map.
        bias: Distance behind the nearest surface up to which another one is still lit [m].
    """

    view: Matrix
    projection: Matrix
    width: int
    height: int
    bias: float


def shadow_camera(
    light: Light, scene: SceneArrays, link_to_world: Matrix, projection: Matrix, width: int, height: int
) -> ShadowCamera:
    """The camera at a light, for an image of this size and projection (4, 4); links have poses (links, 4, 4).

    For a lamp at a finite distance it has the projection of the image, as in PyBullet. For parallel light its
    view covers all shapes that may cast a shadow.
    """
    direction = unit_vector(np.array(light.direction))
    if not isinf(light.distance):
        eye = light.distance * direction
        # A lamp may be so far away that the place in front of it has the same numbers.
        view = look_along(eye, -direction)
        return ShadowCamera(view, projection, width, height, _LAMP_BIAS)
    centre, radius = _casters(scene, link_to_world)
    return ShadowCamera(
        look_at(centre + 2.0 * radius * direction, centre),
        parallel_projection(radius, radius, 3.0 * radius),
        PARALLEL_MAP_SIDE,
        PARALLEL_MAP_SIDE,
        _PARALLEL_BIAS * 2.0 * radius / PARALLEL_MAP_SIDE,
    )


def _casters(scene: SceneArrays, link_to_world: Matrix) -> tuple[Matrix, float]:
    """Centre and radius [m] of a bounding sphere of all shapes that may cast shadows."""
    casts = scene.part_radii < LARGEST_CASTER
    if not casts.any():
        return np.zeros(3), 1.0
    poses = link_to_world[scene.part_links[casts]]
    centres = product(poses[:, :3, :3], scene.part_centres[casts][:, :, None])[:, :, 0] + poses[:, :3, 3]
    radii = scene.part_radii[casts][:, None]
    low, high = (centres - radii).min(axis=0), (centres + radii).max(axis=0)
    middle = 0.5 * (low + high)
    return middle, max(float((np.linalg.norm(centres - middle, axis=1) + radii[:, 0]).max()), 1e-3)
