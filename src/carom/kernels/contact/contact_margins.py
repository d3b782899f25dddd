"""Contact margins: the maximum distance of two shapes in contact, as in Bullet.

A contact is given up where its points are further apart than the smaller *breaking distance* of the
two shapes, and most pairs make one as early as that, so that it can slow them in time.
"""

import warp as wp

from carom.kernels.contact.bounds import local_center, local_extents, magnitudes
from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import BOX, PLANE, SPHERE, TRIANGLES

IDENTITY_TOLERANCE = real(1.0e-12)


@func
def breaking_distance(shapes: Shapes, a: Int32, b: Int32) -> real:
    """Distance at which a contact of two shapes ends [m]."""
    return minimum(shapes.shape_breaking[a], shapes.shape_breaking[b])


@func
def is_part_of_compound(shapes: Shapes, shape: Int32) -> bool:
    """Whether Bullet would wrap a shape in a compound: its link has others, or it is not at the origin."""
    if shapes.link_shape_count[shapes.shape_link[shape]] > 1:
        return True
    pose = shapes.shape_pose[shape]
    offset = wp.transform_get_translation(pose)
    turn = wp.transform_get_rotation(pose)
    return wp.dot(offset, offset) + turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] > (
        IDENTITY_TOLERANCE * IDENTITY_TOLERANCE
    )


@func
def bounds_margin(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32) -> real:
    """Gap between the bounds of two shapes up to which they can be in contact [m].

    Bullet widens the bounds of bodies, but not those of the parts of compounds. Those of planes are infinite,
    so that everything meets them.
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    on_plane = shapes.shape_kind[a] == PLANE or shapes.shape_kind[b] == PLANE
    if not on_plane and (is_part_of_compound(shapes, a) or is_part_of_compound(shapes, b)):
        return ahead
    return maximum(ahead, breaking_distance(shapes, a, b))


@func
def meets_beside(shapes: Shapes, pairs: Pairs, world: Int32, part: Int32, other: Int32) -> bool:
    """Whether a part of a compound and a shape that is none may begin to touch.

    Bullet looks for the parts that a shape meets along the axes of their own link. Bounds along the world's
    have met already.
    """
    if not is_part_of_compound(shapes, part) or is_part_of_compound(shapes, other):
        return True
    if shapes.shape_kind[other] == PLANE or shapes.shape_kind[other] >= TRIANGLES:
        return True
    pose = shapes.shape_pose[part]
    frame = wp.quat_to_matrix(wp.transform_get_rotation(pose))
    # From the axes of the world to those of the link.
    turn = frame * wp.transpose(pairs.shape_frame[world, part])
    other_frame = turn * pairs.shape_frame[world, other]
    apart = turn * (
        pairs.shape_position[world, other]
        + pairs.shape_frame[world, other] * local_center(shapes, other)
        - pairs.shape_position[world, part]
        - pairs.shape_frame[world, part] * local_center(shapes, part)
    )
    room = magnitudes(frame) * local_extents(shapes, part)
    if shapes.shape_kind[other] == SPHERE:
        room += local_extents(shapes, other)
    else:
        room += magnitudes(other_frame) * local_extents(shapes, other)
    ahead = pairs.shape_motion[world, part] + pairs.shape_motion[world, other]
    return (
        wp.abs(apart[0]) <= room[0] + ahead
        and wp.abs(apart[1]) <= room[1] + ahead
        and wp.abs(apart[2]) <= room[2] + ahead
    )


@func
def region_margin(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, in_contact: bool) -> real:
    """Distance from the bounds of a shape up to which triangles of a mesh or height field count [m].

    Bullet looks at those that meet the bounds, and keeps what contacts there are until their sides have
    parted.
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    if in_contact:
        return maximum(ahead, breaking_distance(shapes, a, b))
    return ahead


@func
def contact_margin(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, in_contact: bool) -> real:
    """Distance up to which two shapes are in contact [m].

    Boxes begin to be, and balls are, only where they touch. Fast bodies with continuous detection are
    as far ahead as they could get in a step.
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if kind_a == SPHERE and kind_b == SPHERE:
        return ahead
    if kind_a == BOX and kind_b == BOX and not in_contact:
        return ahead
    return maximum(ahead, breaking_distance(shapes, a, b))
