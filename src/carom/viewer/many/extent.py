"""How much room a world takes in a grid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.description.transform import compose
from carom.model.body_spec import BASE
from carom.render.appearance import appearance_of
from carom.render.meshes import shape_mesh
from carom.scene.handles import present_link_frame
from carom.viewer.looks.shapes import is_floor

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# Room between neighbours, as a part of their size, and at least [m].
_MARGIN, _LEAST = 0.25, 0.5


def is_ground(body: BodyCore) -> bool:
    """Whether a body is a floor that stands fixed: it is that of all worlds, and drawn once."""
    if not body.fixed_base or body.joint_count or body.spec.soft is not None:
        return False
    shapes = body.spec.base.collisions
    return bool(shapes) and all(is_floor(shape.geometry) for shape in shapes)


def extent_of(world: WorldCore) -> tuple[tuple[float, float], float]:
    """The middle of a world from above, and how far apart copies of it do not meet as they are now [m]."""
    appearance = appearance_of(world)
    lower, upper = np.full(2, np.inf), np.full(2, -np.inf)
    for body in world.bodies.values():
        if is_ground(body):
            continue
        for link in range(BASE, body.joint_count):
            with world.call_lock:
                pose = present_link_frame(body, link)
            for look in appearance.shapes(body, link):
                mesh = shape_mesh(look.geometry) if look.mesh is None else look.mesh
                if not len(mesh.positions):
                    continue
                centre = np.array(compose(pose, look.frame).position[:2])
                radius = float(np.linalg.norm(mesh.positions, axis=1).max())
                lower, upper = np.minimum(lower, centre - radius), np.maximum(upper, centre + radius)
    if not np.isfinite(lower).all():
        return (0.0, 0.0), _LEAST
    x, y = (0.5 * (lower + upper)).tolist()
    return (x, y), max(_LEAST, (1.0 + _MARGIN) * float((upper - lower).max()))
