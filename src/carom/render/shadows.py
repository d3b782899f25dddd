"""Cameras at the light, for shadow mapping."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isinf

import numpy as np
from numpy.typing import NDArray

from carom.native.products import dots, product
from carom.render.lights import Light
from carom.render.projection import Matrix, look_along, parallel_projection, unit_vector
from carom.render.scene import SceneArrays

MIN_MAP_SIDE = 128
MAX_MAP_SIDE = 1024
"""Limits of the width and height of the shadow map of parallel light [pixels]."""

LARGEST_CASTER = 50.0
"""Bounding radius above which a shape, such as a floor, casts no shadow in parallel light [m]."""

# Shadow bias: a surface this far behind the nearest one is still lit, or it would shade itself.
_LAMP_BIAS = 0.05
"""Of a lamp [m]."""
_PARALLEL_BIAS = 3.0
"""Of parallel light [pixels of the shadow map]."""


@dataclass(frozen=True, repr=False, eq=False, slots=True)
class ShadowCameras:
    """A camera at the light in each of n worlds; its depth buffer is the shadow map.

    Attributes:
        world_to_clip: (n, 4, 4) world to clip coordinates.
        projections: (n, 4, 4) eye to clip coordinates.
        width: Columns of a shadow map.
        height: Rows of a shadow map.
        biases: (n,) distance behind the nearest surface up to which another one is still lit [m].
    """

    world_to_clip: Matrix
    projections: Matrix
    width: int
    height: int
    biases: Matrix


def shadow_cameras(
    light: Light,
    scene: SceneArrays,
    link_to_world: Matrix,
    projection: Matrix,
    width: int,
    height: int,
    growth: Matrix | None = None,
) -> ShadowCameras:
    """The cameras at a light, for images of this size and projection (4, 4).

    For a lamp at a finite distance they have the size and the projection of the image, as in PyBullet. For
    parallel light their views cover all shapes that may cast a shadow, and the maps are squares with the
    longer side of the image.

    Args:
        light: The light.
        scene: What is visible.
        link_to_world: (n, links, 4, 4) poses of the links in each world.
        projection: Eye to clip coordinates of the image.
        width: Columns of the image.
        height: Rows of the image.
        growth: (n, links) factors on the radii of bounding spheres; None for none.
    """
    direction = unit_vector(np.array(light.direction))
    count = len(link_to_world)
    if not isinf(light.distance):
        eye = light.distance * direction
        # A lamp may be so far away that the place in front of it has the same numbers.
        clip = product(projection, look_along(eye, -direction))
        clips, projections = (np.repeat(matrix[None], count, axis=0) for matrix in (clip, projection))
        return ShadowCameras(clips, projections, width, height, np.full(count, _LAMP_BIAS))
    centres, radii = _casters(scene, link_to_world, growth)
    side = min(max(width, height, MIN_MAP_SIDE), MAX_MAP_SIDE)
    views = np.repeat(look_along(np.zeros(3), -direction)[None], count, axis=0)
    eyes = centres + 2.0 * radii[:, None] * direction
    views[:, :3, 3] = product(-views[:, :3, :3], eyes[:, :, None])[:, :, 0]
    projections = np.zeros((count, 4, 4))
    for projection, radius in zip(projections, radii.tolist(), strict=True):
        projection[:] = parallel_projection(radius, radius, 3.0 * radius)
    return ShadowCameras(
        product(projections, views), projections, side, side, _PARALLEL_BIAS * 2.0 * radii / side
    )


def shadows_of(
    lights: Sequence[Light],
    scene: SceneArrays,
    link_to_world: Matrix,
    projection: Matrix,
    width: int,
    height: int,
    growth: Matrix | None = None,
) -> ShadowCameras:
    """The cameras at one light for all worlds, or at that of each; arguments are as of `shadow_cameras`.

    The projection may be one for each world. Worlds whose light casts no shadow get cameras all the same.

    Raises:
        ValueError: Some of the lights are lamps, and some are parallel: their maps have different sizes.
    """
    if len(lights) == 1 and projection.ndim == 2:
        return shadow_cameras(lights[0], scene, link_to_world, projection, width, height, growth)
    if len({isinf(light.distance) for light in lights if light.shadow}) > 1:
        raise ValueError(
            "lights with shadows must all be parallel, of distance inf, or all be lamps at a finite distance"
        )
    a_light = next(light for light in lights if light.shadow)
    found = []
    for world in range(len(link_to_world)):
        light = lights[world if len(lights) > 1 else 0]
        lens = projection if projection.ndim == 2 else projection[world]
        place = link_to_world[world : world + 1]
        own = None if growth is None else growth[world : world + 1]
        light = light if light.shadow else a_light
        found.append(shadow_cameras(light, scene, place, lens, width, height, own))
    return ShadowCameras(
        np.concatenate([each.world_to_clip for each in found]),
        np.concatenate([each.projections for each in found]),
        found[0].width,
        found[0].height,
        np.concatenate([each.biases for each in found]),
    )


def _casters(
    scene: SceneArrays, link_to_world: Matrix, growth: Matrix | None = None
) -> tuple[Matrix, Matrix]:
    """Centres (n, 3) and radii (n,) [m] of bounding spheres of all shapes that may cast shadows."""
    casts = scene.part_radii < LARGEST_CASTER
    if not casts.any():
        return np.zeros((len(link_to_world), 3)), np.ones(len(link_to_world))
    poses = link_to_world[:, scene.part_links[casts]]
    centres = product(poses[..., :3, :3], scene.part_centres[casts][:, :, None])[..., 0] + poses[..., :3, 3]
    radii = scene.part_radii[casts]
    if growth is not None:
        radii = radii * growth[:, scene.part_links[casts]]
    # Matrices of absent bodies are all zeros.
    absent = poses[..., 3, 3] == 0.0
    if absent.any():
        centres = np.where(absent[..., None], _present_centres(centres, absent)[:, None], centres)
        radii = np.where(absent, 0.0, radii)
    else:
        radii = np.atleast_2d(radii)
    low = (centres - radii[..., None]).min(axis=1)
    high = (centres + radii[..., None]).max(axis=1)
    middle = 0.5 * (low + high)
    away = centres - middle[:, None]
    return middle, np.maximum((np.sqrt(dots(away, away)) + radii).max(axis=1), 1e-3)


def _present_centres(centres: Matrix, absent: NDArray[np.bool_]) -> Matrix:
    """The centre of the first part that is present in each world, (n, 3); 0 where all are absent."""
    first = centres[np.arange(len(centres)), absent.argmin(axis=1)]
    return np.where(np.all(absent, axis=1, keepdims=True), 0.0, first)
