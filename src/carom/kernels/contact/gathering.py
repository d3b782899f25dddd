"""Manifolds of what does not lie on a face: they gather their points over the steps, as Bullet's do.

Bullet adds one point in a step, the deepest, and keeps those of the steps before until their sides have
parted. A face that lies flat has all its corners after a few steps, so a manifold made at once is as good and
steadier, and which of its points is the deepest is up to rounding. But what rolls or tumbles never comes so
far: new points enter where it rolls to, old ones linger where it rolled from, and both decide how deep it
rolls and how it scrubs sideways. So hulls, cylinders and capsules get their points by Bullet's rules unless
they lie on a face, and on infinite planes all shapes do.
"""

import math

import warp as wp

from carom.kernels.contact.candidates import candidate_normal, flip_candidates
from carom.kernels.contact.narrow_phase import collide_shapes, in_order
from carom.kernels.queries.closest import nearest_convex
from carom.kernels.shapes.cores import core_of
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Index4, Int32, Vector3, func, real
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

# Cosine of the angle between axis and normal up to which a shape lies on its side.
ON_SIDE = real(math.sqrt(0.5))
# Cosine of the angle between face and contact, 1.8 degrees, beyond which a shape lies on the face.
ON_FACE = real(0.9995)
# There is no new point to add, as the manifold is to be made at once.
AT_ONCE = wp.constant(-1)


@func
def rolls(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is round about an axis, or a hull."""
    return shapes.shape_rolling[shape] != NO_ROLLING


@func
def is_single_sided(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape is one point or many triangles for its partners, so that nothing is gathered."""
    kind = shapes.shape_kind[shape]
    return kind == SPHERE or kind >= TRIANGLES


@func
def lies_on_face(shapes: Shapes, shape: Int32, outward: Vector3) -> bool:
    """Whether a hull touches with a face on which it can lie; `outward` is a direction in its frame."""
    first = shapes.shape_first_face[shape]
    for face in range(first, first + shapes.shape_flat_faces[shape]):
        plane = shapes.face_plane[face]
        if plane[0] * outward[0] + plane[1] * outward[1] + plane[2] * outward[2] > ON_FACE:
            return True
    return False


@func
def rolls_on(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, outward: Vector3) -> bool:
    """Whether a shape, if it rolls, touches with something on which it does, and not with a face.

    Args:
        shapes: All shapes.
        pairs: Poses of the shapes.
        world: The world.
        shape: The shape.
        outward: The contact's normal, out of the shape.
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

    On planes all shapes gather their points, also where they lie on a face: boxes that land flat tip and
    creep by them. On faces of other shapes the deepest point of what lies exactly flat is in the middle, and
    would stay alone.
    """
    return shapes.shape_kind[a] == PLANE or shapes.shape_kind[b] == PLANE


@func
def gathers(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, normal: Vector3) -> bool:
    """Whether a manifold with this normal gathers its points."""
    if gathers_everywhere(shapes, a, b):
        return True
    return rolls_on(shapes, pairs, world, a, -normal) or rolls_on(shapes, pairs, world, b, normal)


@func
def find_new_points(
    shapes: Shapes, pairs: Pairs, world: Int32, sides: Index4, max_distance: real, first: Int32, last: Int32
) -> Int32:
    """Write what is new in a manifold that gathers its points: the deepest; of two boxes up to four.

    Args:
        shapes: All shapes.
        pairs: Room for candidates, poses of the shapes, and the previous contacts.
        world: The world.
        sides: The two shapes.
        max_distance: Largest distance of a contact [m].
        first: First previous contact of the two shapes.
        last: End of these.

    Returns:
        How many there are; `AT_ONCE` if the manifold does not gather.
    """
    a = sides[0]
    b = sides[1]
    if is_single_sided(shapes, a) or is_single_sided(shapes, b):
        return AT_ONCE
    boxes = shapes.shape_kind[a] == BOX and shapes.shape_kind[b] == BOX
    if not (boxes or rolls(shapes, a) or rolls(shapes, b) or gathers_everywhere(shapes, a, b)):
        return AT_ONCE
    if pairs.shape_motion[world, a] + pairs.shape_motion[world, b] > 0.0:
        # What is stopped at one end only would swing through with the other.
        return AT_ONCE
    if boxes:
        # Only where they touch; points of before stay up to the breaking distance.
        return collide_shapes(shapes, pairs, world, a, b, 0.0, 0.0)
    if last > first:
        if not gathers(shapes, pairs, world, a, b, pairs.previous_normal[world, first]):
            return AT_ONCE
    order = in_order(shapes, a, b)
    found = nearest_convex(
        shapes, pairs, world, order[0], order[1], core_of(shapes, pairs, world, order[0]), max_distance
    )
    if order[0] != a:
        flip_candidates(pairs.candidate_terms, world, found)
    if last == first and found > 0:
        if not gathers(shapes, pairs, world, a, b, candidate_normal(pairs.candidate_terms, world, 0)):
            return AT_ONCE
    return found
