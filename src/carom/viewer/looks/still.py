"""A picture of a world, for notebooks whose browser cannot reach the page."""

from __future__ import annotations

import math
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore

WIDTH, HEIGHT = 640, 420
_FIELD_OF_VIEW = math.radians(50.0)
# The same direction as in the first view of pages.
_YAW, _PITCH = math.radians(50.0), math.radians(-35.0)
# Margin around the centres of links [m].
_ROOM = 0.25
_NEAR, _FAR = 0.02, 200.0


def still(world: WorldCore) -> bytes | None:
    """A PNG file of the bodies of a world at present, as in the first view of pages; None without bodies.

    The world must not be stepped meanwhile.
    """
    from PIL import Image

    from carom.model.body_spec import BASE
    from carom.render.appearance import appearance_of
    from carom.render.lights import Light
    from carom.render.projection import look_at, pinhole_projection
    from carom.render.renderer import renderer_of
    from carom.scene.handles import present_link_frame

    bodies = list(world.bodies.values())
    if not bodies:
        return None
    appearance_of(world)
    with world.call_lock:
        places = np.array(
            [
                present_link_frame(body, link).position
                for body in bodies
                for link in range(BASE, body.joint_count)
            ]
        )
    lower, upper = places.min(axis=0), places.max(axis=0)
    target = 0.5 * (lower + upper)
    radius = 0.5 * float(np.linalg.norm(upper - lower)) + _ROOM
    forward = np.array(
        [-math.cos(_PITCH) * math.sin(_YAW), math.cos(_PITCH) * math.cos(_YAW), math.sin(_PITCH)]
    )
    eye = target - forward * radius / math.sin(0.5 * _FIELD_OF_VIEW)
    focal = 0.5 * HEIGHT / math.tan(0.5 * _FIELD_OF_VIEW)
    projection = pinhole_projection(
        WIDTH, HEIGHT, focal, focal, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1), _NEAR, _FAR
    )
    image = renderer_of(world).draw(world, look_at(eye, target), projection, WIDTH, HEIGHT, Light())
    file = BytesIO()
    Image.fromarray(image.rgba[..., :3]).save(file, "png")
    return file.getvalue()
