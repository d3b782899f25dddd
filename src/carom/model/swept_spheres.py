"""Capsules that an MJCF file gives by their ends: in PyBullet, swept spheres in the frame of the ends.

They collide like capsules, but their bounds are along the axes of that frame and 4 cm larger on each side,
and that frame decides whether such a shape counts as lying exactly in the inertial frame. Cylinders, and
capsules loaded with `URDF_USE_IMPLICIT_CYLINDER`, are compounds of one shape in the same frame.
"""

from __future__ import annotations

from dataclasses import replace

from carom.description import Collision
from carom.description.shapes.bounds import Bounds
from carom.description.transform import NO_ROTATION, compose, inverse, rotation_matrix
from carom.model.bounds import shape_bounds

FIRST_MARGIN = 0.04
"""Bullet's default margin [m], which swept spheres keep, and hulls have while they are made."""


def as_given(collision: Collision) -> Collision:
    """The shape with its pose in the file; that of a shape given by its ends is the frame of the ends."""
    return collision if collision.ends_frame is None else replace(collision, frame=collision.ends_frame)


def bounds_between_ends(collision: Collision, margin: float) -> Bounds:
    """Bounds of a capsule or cylinder along the axes of the frame in which its ends are given.

    The margin widens those of a swept sphere [m].
    """
    assert collision.ends_frame is not None, "the shape is given by its ends"
    within = compose(inverse(collision.ends_frame), collision.frame)
    rotation = rotation_matrix(within.orientation)
    geometry = collision.geometry
    if not collision.swept:
        return shape_bounds(geometry, implicit_cylinder=True).placed(rotation, within.position)
    return (
        Bounds((0.0, 0.0, 0.0), geometry.swept_half(rotation))
        .grown(margin)
        .placed(NO_ROTATION, within.position)
    )
