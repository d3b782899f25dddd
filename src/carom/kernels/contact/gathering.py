"""Contact manifolds that gather their points over several steps, as in Bullet.

In each step Bullet adds one point, the deepest, and keeps the points of earlier steps until they have
separated. A face that lies flat has all its corners after a few steps. There a manifold made at once is
equally good, and steadier, because rounding decides which corner is the deepest. The manifold of a shape that
rolls or tumbles is never complete: new points come in front, old points remain behind, and both affect the
penetration depth and the sideways scrubbing. So hulls, cylinders and capsules gather their points by Bullet's
rules unless they lie on a face. On infinite planes all shapes gather their points.

Two boxes get up to four new points in a step, those that touch, and keep points of earlier steps as well.
Boxes at rest keep exactly the points they have.
"""

import math

import warp as wp

from carom.kernels.contact.candidates import flip_candidates
from carom.kernels.contact.narrow_phase import collide_boxes, in_order
from carom.kernels.maths.min_max import greatest_entry
from carom.kernels.queries.closest import nearest_convex
from carom.kernels.shapes.cores import core_of
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Index2, Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import (
    BOX,
    HULL,
    NO_ROLLING,
    PLANE,
    ROLLING_ABOUT_ANY,
    ROLLING_ABOUT_X,
    ROLLING_OFF_FACES,
    SPHERE,
    TRIANGLES,
)
from carom.layouts.contacts import HOLDING

# A hull lies on its side if the cosine of the angle between its axis and the normal is less than this.
ON_SIDE = real(math.sqrt(0.5))
# A shape lies on a face if the cosine of the angle between the normals of face and contact exceeds this (an
# angle of 1.8 degrees).
ON_FACE = real(0.9995)
# The normal of a manifold is that of a face if the cosine of the angle between them exceeds this (an angle of
# 1e-5).
SAME_FACE = real(1.0 - 5.0e-11)
# Counter of the contacts of a manifold that held in the last step.
HELD = real(HOLDING)
# Result of `find_new_points`: the manifold is made at once instead of gathering points.
AT_ONCE = wp.constant(-1)


@func
def rolls(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape can roll: it is round about an axis, or a hull."""
    return shapes.shape_rolling[shape] != NO_ROLLING


@func
def is_single_sided(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is a sphere or consists of triangles, so that its manifolds gather no points."""
    kind = shapes.shape_kind[shape]
    return kind == SPHERE or kind >= TRIANGLES


@func
def are_boxes(shapes: Shapes, a: Int32, b: Int32) -> bool:
    """Whether two shapes are both boxes."""
    return shapes.shape_kind[a] == BOX and shapes.shape_kind[b] == BOX


@func
def lies_on_face(shapes: Shapes, shape: Int32, outward: Vector3) -> bool:
    """Whether a hull touches with a face on which it can lie; `outward` is the normal in its frame."""
    first = shapes.shape_first_face[shape]
    for face in range(first, first + shapes.shape_flat_faces[shape]):
        plane = shapes.face_plane[face]
        if plane[0] * outward[0] + plane[1] * outward[1] + plane[2] * outward[2] > ON_FACE:
            return True
    return False


@func
def rolls_on(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, outward: Vector3) -> bool:
    """Whether a shape touches with a surface on which it rolls, not with a face on which it lies.

    `outward` is the contact's normal, out of the shape.
    """
    about = shapes.shape_rolling[shape]
    if about == NO_ROLLING or about == ROLLING_ABOUT_ANY:
        return about == ROLLING_ABOUT_ANY
    local = wp.transpose(pairs.shape_frame[world, shape]) * outward
    if about != ROLLING_OFF_FACES:
        along = wp.abs(local[about - ROLLING_ABOUT_X])
        if shapes.shape_kind[shape] != HULL:
            return along < ON_FACE
        if along < ON_SIDE:
            return True
    return not lies_on_face(shapes, shape, local)


@func
def gathers_everywhere(shapes: Shapes, a: Int32, b: Int32) -> bool:
    """Whether one of two shapes is an infinite plane.

    On planes all shapes gather their points, even if they lie on a face; therefore boxes that land flat tip
    and creep, as in Bullet. On a face of another shape, the deepest point of a shape that lies exactly flat
    is in the middle of the face, and would remain the only point.
    """
    return shapes.shape_kind[a] == PLANE or shapes.shape_kind[b] == PLANE


@func
def gathers(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, normal: Vector3) -> bool:
    """Whether a manifold with this normal gathers its points."""
    if gathers_everywhere(shapes, a, b):
        return True
    return rolls_on(shapes, pairs, world, a, -normal) or rolls_on(shapes, pairs, world, b, normal)


@func
def lies_along(frame: Matrix3, normal: Vector3) -> bool:
    """Whether a box with the axes `frame` has a face perpendicular to `normal`."""
    along = wp.abs(wp.transpose(frame) * normal)
    return greatest_entry(along) > SAME_FACE


@func
def keeps_points(pairs: Pairs, world: Int32, a: Int32, b: Int32, first: Int32, last: Int32) -> bool:
    """Whether the previous contacts [first, last) of two boxes at rest stay as they are.

    They do if they held in the last step. Which corners of two boxes are found depends on rounding if their
    edges are nearly parallel: new points that replaced others would disturb what is at rest. A manifold is
    made anew if the boxes have turned together, because its normal does not turn with them.
    """
    if last - first < 3:
        return False
    for row in range(first, last):
        if pairs.previous_warm_start[world, row] < HELD:
            return False
    normal = pairs.previous_normal[world, first]
    return lies_along(pairs.shape_frame[world, a], normal) or lies_along(pairs.shape_frame[world, b], normal)


@func
def find_new_points(
    shapes: Shapes, pairs: Pairs, world: Int32, sides: Index2, max_distance: real, first: Int32, last: Int32
) -> Int32:
    """Write the new candidates of a manifold that gathers its points: the deepest; of two boxes up to four.

    `max_distance` is the largest distance of a contact [m], [first, last) are the previous contacts of the
    pair.

    Returns:
        Number of candidates written, 0 if the shapes are too far apart; `AT_ONCE` if the manifold does not
        gather its points.
    """
    a, b = sides[0], sides[1]
    if is_single_sided(shapes, a) or is_single_sided(shapes, b):
        return AT_ONCE
    boxes = are_boxes(shapes, a, b)
    if not (boxes or rolls(shapes, a) or rolls(shapes, b) or gathers_everywhere(shapes, a, b)):
        return AT_ONCE
    if pairs.shape_motion[world, a] + pairs.shape_motion[world, b] > 0.0:
        # A fast shape that is stopped at one point only would swing through the surface with its other end.
        return AT_ONCE
    if boxes:
        if keeps_points(pairs, world, a, b, first, last):
            return 0
        # Only points that touch are new; previous ones stay up to the breaking distance.
        return collide_boxes(shapes, pairs, world, a, b, 0.0)
    if last > first:
        if not gathers(shapes, pairs, world, a, b, pairs.previous_normal[world, first]):
            return AT_ONCE
    first_shape, second_shape = in_order(shapes, a, b)
    core = core_of(shapes, pairs, world, first_shape)
    found = nearest_convex(shapes, pairs, world, first_shape, second_shape, core, max_distance)
    if first_shape != a:
        flip_candidates(pairs.candidate, world, found)
    if last == first and found > 0:
        if not gathers(shapes, pairs, world, a, b, pairs.candidate[world, 0].normal):
            return AT_ONCE
    return found
