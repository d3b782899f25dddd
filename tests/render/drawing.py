"""Worlds to draw, and an independent way to know what must be seen: rays against boxes."""

from __future__ import annotations

import numpy as np

from carom.description import Box, Collision, Geometry, Material, Pose, Visual
from carom.model.body_spec import BodySpec, LinkSpec
from carom.render.image_target import RawImage
from carom.render.lights import Light
from carom.render.projection import look_at, pinhole_projection
from carom.render.renderer import renderer_of
from carom.scene.body import Body
from carom.world.world import World

NEAR, FAR = 0.1, 50.0


def add_shape(
    world: World,
    geometry: Geometry,
    position=(0.0, 0.0, 0.0),
    orientation=(0.0, 0.0, 0.0, 1.0),
    material: Material | None = None,
) -> Body:
    """A body of one link that shows one shape."""
    visual = Visual(geometry, material=material)
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), visuals=(visual,))
    return world.load(BodySpec("shape", base), position, orientation)


def add_collision_only(world: World, geometry: Geometry) -> Body:
    """A body that states what it collides with, but no looks."""
    base = LinkSpec("base", mass=1.0, inertia=(1.0, 1.0, 1.0), collisions=(Collision(geometry, Pose()),))
    return world.load(BodySpec("shape", base))


def draw(
    world: World,
    eye=(0.0, -5.0, 0.0),
    target=(0.0, 0.0, 0.0),
    size: tuple[int, int] = (48, 36),
    focal: float = 40.0,
    light: Light | None = None,
) -> RawImage:
    """An image by a pinhole camera whose axis meets the middle of the image."""
    width, height = size
    projection = pinhole_projection(
        width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1), NEAR, FAR
    )
    return renderer_of(world).draw(world, look_at(eye, target), projection, width, height, light or Light())


def rays(eye, target, size: tuple[int, int], focal: float) -> np.ndarray:
    """(height, width, 3) directions of the rays through all pixels, 1 m along the axis of the camera."""
    width, height = size
    rotation = look_at(eye, target)[:3, :3]
    x = (np.arange(width) - 0.5 * (width - 1)) / focal
    y = (np.arange(height) - 0.5 * (height - 1)) / focal
    local = np.stack(np.broadcast_arrays(x[None, :], -y[:, None], -1.0), axis=-1)
    return local @ rotation


def first_hit(origin, directions: np.ndarray, box: Box, rotation: np.ndarray, position) -> np.ndarray:
    """Multiples of the directions at which rays enter a box; infinite for those that miss."""
    start = (np.asarray(origin) - position) @ rotation
    along = directions @ rotation
    half = np.array(box.half_extents)
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (-half - start) / along, (half - start) / along
    enter = np.minimum(one, other).max(axis=-1)
    leave = np.maximum(one, other).min(axis=-1)
    return np.where((enter <= leave) & (enter > NEAR), enter, np.inf)
