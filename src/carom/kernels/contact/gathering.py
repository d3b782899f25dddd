"""Contact manifolds that gather their points over several steps, as in Bullet.

In each step Bullet adds one point, the deepest, and keeps the points of earlier steps until they have
separated. So what lands flat tips over its first points and creeps, and the manifold of a shape that rolls or
tumbles is never complete: new points come in front, old points remain behind, and both affect the penetration
depth and the sideways scrubbing. Two boxes get up to four new points in a step, those that touch, and keep
points of earlier steps as well.

What is at rest keeps exactly the points it has. Contacts that yield gather no points.
"""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.contact.narrow_phase import collide_boxes, collide_shapes, has_yielding_contacts
from carom.kernels.maths.min_max import greatest_entry
from carom.kernels.queries.closest import nearest
from carom.kernels.shapes.bullet_gjk import FOUND, TOO_FAR, nearest_as_in_bullet
from carom.kernels.shapes.cores import core_of
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Index2, Int32, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, HULL, PLANE, SPHERE, TRIANGLES
from carom.layouts.contacts import HOLDING

# The normal of a manifold is that of a face if the cosine of the angle between them exceeds this (an angle of
# 1e-5).
SAME_FACE = real(1.0 - 5.0e-11)
# Counter of the contacts of a manifold that held in the last step.
HELD = real(HOLDING)
# Result of `find_new_points`: the manifold is made at once instead of gathering points.
AT_ONCE = wp.constant(-1)


@func
def gathers_nothing(kind_a: Int32, kind_b: Int32) -> bool:
    """Whether manifolds of these kinds of shapes gather no points: of two spheres, or with triangles."""
    return (kind_a == SPHERE and kind_b == SPHERE) or kind_a >= TRIANGLES or kind_b >= TRIANGLES


@func
def are_boxes(shapes: Shapes, a: Int32, b: Int32) -> bool:
    """Whether two shapes are both boxes."""
    return shapes.shape_kind[a] == BOX and shapes.shape_kind[b] == BOX


@func
def lies_along(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, normal: Vector3) -> bool:
    """Whether a shape has a face perpendicular to `normal`."""
    kind = shapes.shape_kind[shape]
    local = wp.transpose(pairs.shape_frame[world, shape]) * normal
    if kind == BOX:
        return greatest_entry(wp.abs(local)) > SAME_FACE
    if kind == CYLINDER:
        return wp.abs(local[2]) > SAME_FACE
    if kind == PLANE:
        return wp.abs(wp.dot(local, shapes.shape_size[world, shape])) > SAME_FACE
    if kind == HULL:
        first = shapes.shape_first_face[shape]
        for face in range(first, first + shapes.shape_face_count[shape]):
            plane = shapes.face_plane[face]
            if wp.abs(plane[0] * local[0] + plane[1] * local[1] + plane[2] * local[2]) > SAME_FACE:
                return True
    return False


@func
def keeps_points(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, first: Int32, last: Int32
) -> bool:
    """Whether the previous contacts [first, last) of two shapes at rest stay as they are.

    They do if they held in the last step. Which corners of parallel faces and edges are found depends on
    rounding: new points that replaced others would disturb what is at rest. A manifold is updated if the
    shapes have turned together, because its normal does not turn with them.
    """
    if last - first < 3:
        return False
    for row in range(first, last):
        if pairs.previous_warm_start[world, row] < HELD:
            return False
    normal = pairs.previous_normal[world, first]
    return lies_along(shapes, pairs, world, a, normal) or lies_along(shapes, pairs, world, b, normal)


@func
def nearest_as_bullet(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, max_distance: real
) -> Int32:
    """Write the nearest candidate where Bullet finds it; returns 1, or 0 if the shapes are too far apart."""
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if kind_a != PLANE and kind_b != PLANE and not (kind_a == CAPSULE and kind_b == CAPSULE):
        core_a = core_of(shapes, pairs, world, a)
        core_b = core_of(shapes, pairs, world, b)
        rounding = core_a.radius + core_b.radius
        outcome, distance, normal, point = nearest_as_in_bullet(
            core_a, core_b, shapes.vertex_position, max_distance + rounding
        )
        if outcome == TOO_FAR:
            return 0
        if outcome == FOUND:
            distance -= rounding
            if distance > max_distance:
                return 0
            return add_candidate(pairs.candidate, world, 0, point + normal * core_b.radius, normal, distance)
    return nearest(shapes, pairs, world, a, b, max_distance)


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
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if gathers_nothing(kind_a, kind_b):
        return AT_ONCE
    if pairs.shape_motion[world, a] + pairs.shape_motion[world, b] > 0.0:
        # A fast shape that is stopped at one point only would swing through the surface with its other end.
        return AT_ONCE
    if has_yielding_contacts(shapes, world, a) or has_yielding_contacts(shapes, world, b):
        # Corners that are found late have sunk in by then.
        return AT_ONCE
    if keeps_points(shapes, pairs, world, a, b, first, last):
        return 0
    if are_boxes(shapes, a, b):
        # Only points that touch are new; previous ones stay up to the breaking distance.
        return collide_boxes(shapes, pairs, world, a, b, 0.0, Int32(4))
    if (kind_a == SPHERE or kind_b == SPHERE) and kind_a != CYLINDER and kind_b != CYLINDER:
        # There is one point. On a cylinder Bullet's search ends beside it.
        return collide_shapes(shapes, pairs, world, a, b, max_distance, 0.0, Vector3(0.0, 0.0, 0.0))
    return nearest_as_bullet(shapes, pairs, world, a, b, max_distance)
