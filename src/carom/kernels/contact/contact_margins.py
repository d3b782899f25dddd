"""Contact margins: the maximum distance of two shapes in contact, as in Bullet.

A contact ends when its points are further apart than the *breaking distance* of its manifold. This
is the smaller one of the two shapes when the manifold is made, and stays as it is. Most pairs of shapes
also begin a contact at this distance, so that it can slow them in time.
"""

import warp as wp

from carom.kernels.contact.bounds import local_center, local_extents, magnitudes
from carom.kernels.dynamics.contact_compliance import yields_without_bounce
from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.structs import Pairs, Settings, Shapes
from carom.kernels.types import Index2, Int32, func, real
from carom.layouts.codes import ALONE, BOX, PLANE, SPHERE, TRIANGLES

# Contacts that push within their margin only are found up to this much beyond it [m]: on its edge a step has
# no derivative, which those who ask for one are told.
_BEYOND = real(1e-6)


@func
def breaking_distance(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> real:
    """Breaking distance of a manifold of two shapes that is made now [m]."""
    return minimum(shapes.shape_breaking[world, a], shapes.shape_breaking[world, b])


@func
def processing_threshold(shapes: Shapes, world: Int32, pair: Index2) -> real:
    """Largest distance at which a contact is solved, of a manifold of two shapes that is made now [m]."""
    return minimum(
        shapes.shape_processing_threshold[world, pair[0]],
        shapes.shape_processing_threshold[world, pair[1]],
    )


@func
def is_part_of_compound(shapes: Shapes, shape: Int32) -> bool:
    """Whether Bullet puts a shape in a compound: its link has other shapes, or its pose is no identity."""
    return shapes.shape_part[shape] != ALONE


@func
def stated_margin(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> real:
    """Distance at which contacts of two shapes begin to push, if they yield [m]."""
    own, other = shapes.shape_mixing[world, a], shapes.shape_mixing[world, b]
    of_both = own[1] + other[1]
    # Only links whose shapes have weights may be in such pairs.
    if own[0] <= 0.0 or other[0] <= 0.0:
        return of_both
    link_a, link_b = shapes.shape_link[a], shapes.shape_link[b]
    return maximum(of_both, minimum(shapes.link_pair_margin[link_a], shapes.link_pair_margin[link_b]))


@func
def most_ahead(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32) -> real:
    """How far from its bounds a shape may meet others: it looks ahead, or pushes within a margin [m].

    Of two shapes the sum counts.
    """
    stated = maximum(shapes.shape_mixing[world, shape][1], shapes.link_pair_margin[shapes.shape_link[shape]])
    return pairs.shape_motion[world, shape] + stated


@func
def bounds_margin(
    shapes: Shapes, settings: Settings, pairs: Pairs, world: Int32, a: Int32, b: Int32, breaking: real
) -> real:
    """Largest gap between the bounds of two shapes that can be in contact [m].

    Bullet widens the bounds of bodies, but not the bounds of the parts of a compound. The bounds of a plane
    are infinite, so every shape meets them. `breaking` is the breaking distance of the pair [m].
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    on_plane = shapes.shape_kind[a] == PLANE or shapes.shape_kind[b] == PLANE
    ahead = maximum(ahead, stated_margin(shapes, world, a, b))
    if not on_plane and (is_part_of_compound(shapes, a) or is_part_of_compound(shapes, b)):
        return ahead
    return maximum(ahead, breaking if on_plane else minimum(breaking, settings.near))


@func
def margin_of_gap(
    shapes: Shapes,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    breaking: real,
    gap: real,
) -> real:
    """As `bounds_margin`, for two shapes with a `gap` [m] between their bounds.

    Those that yield without bouncing push each other within their stated margin only.
    """
    margin = bounds_margin(shapes, settings, pairs, world, a, b, breaking)
    if gap > 0.0 and gap <= margin and yields_without_bounce(shapes, world, a, b):
        return stated_margin(shapes, world, a, b)
    return margin


@func
def meets_beside(shapes: Shapes, pairs: Pairs, world: Int32, part: Int32, other: Int32) -> bool:
    """Whether a part of a compound and a shape that is not in a compound may begin a contact.

    Bullet tests a shape's bounds against those of the parts along the axes of the parts' link. The bounds
    along the world axes are known to meet already.
    """
    if not is_part_of_compound(shapes, part) or is_part_of_compound(shapes, other):
        return True
    if shapes.shape_kind[part] == PLANE:
        return True
    if shapes.shape_kind[other] == PLANE or shapes.shape_kind[other] >= TRIANGLES:
        return True
    pose = shapes.shape_pose[part]
    frame = wp.quat_to_matrix(wp.transform_get_rotation(pose))
    # Rotation from world axes to the axes of the link.
    turn = frame * wp.transpose(pairs.shape_frame[world, part])
    other_frame = turn * pairs.shape_frame[world, other]
    apart = turn * (
        pairs.shape_position[world, other]
        + pairs.shape_frame[world, other] * local_center(shapes, other)
        - pairs.shape_position[world, part]
        - pairs.shape_frame[world, part] * local_center(shapes, part)
    )
    room = magnitudes(frame) * local_extents(shapes, world, part)
    if shapes.shape_kind[other] == SPHERE:
        room += local_extents(shapes, world, other)
    else:
        room += magnitudes(other_frame) * local_extents(shapes, world, other)
    ahead = pairs.shape_motion[world, part] + pairs.shape_motion[world, other]
    return (
        wp.abs(apart[0]) <= room[0] + ahead
        and wp.abs(apart[1]) <= room[1] + ahead
        and wp.abs(apart[2]) <= room[2] + ahead
    )


@func
def region_margin(pairs: Pairs, world: Int32, a: Int32, b: Int32, breaking: real, in_contact: bool) -> real:
    """Distance from a shape's bounds within which triangles of a mesh or height field are tested [m].

    Bullet tests the triangles that meet the bounds, and keeps existing contacts up to the breaking distance.
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    if in_contact:
        return maximum(ahead, breaking)
    return ahead


@func
def contact_margin(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, breaking: real, in_contact: bool
) -> real:
    """Contact margin: largest distance of two shapes in contact [m].

    Zero for two spheres, for two boxes without a contact so far, and for shapes that yield without bouncing,
    which push each other within their margin only; the breaking distance for other pairs.
    With continuous collision detection it is at least the distance that fast shapes can move in a step. It
    is at least the margin of both shapes, too.
    """
    ahead = pairs.shape_motion[world, a] + pairs.shape_motion[world, b]
    stated = stated_margin(shapes, world, a, b)
    if yields_without_bounce(shapes, world, a, b):
        return stated + _BEYOND
    if stated > 0.0:
        return maximum(maximum(ahead, breaking), stated)
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if kind_a == SPHERE and kind_b == SPHERE:
        return ahead
    if kind_a == BOX and kind_b == BOX and not in_contact:
        return ahead
    return maximum(ahead, breaking)
