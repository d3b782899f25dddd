"""Contact candidates of convex shapes on triangle meshes and height fields."""

import warp as wp

from carom.kernels.contact.bounds import local_center, local_extents, magnitudes
from carom.kernels.contact.candidates import exchange, keep_four
from carom.kernels.shapes.convex import collide_convex, nearest_or_deepest
from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.faces import triangle_normal
from carom.kernels.shapes.triangles import (
    Region,
    first_cursor,
    following_cursor,
    region_of,
    triangle_core,
    triangle_corners,
    triangle_from,
)
from carom.kernels.structs import CandidateRows, Pairs, Shapes
from carom.kernels.types import Int32, Vector3, func, real, shared_func
from carom.layouts.codes import SPHERE, TRIANGLES

# A candidate is on a face if the cosine of the angle between the normals of both is at least this.
ON_FACE = real(0.999999)
# Height above a face up to which an edge belongs to the face, in addition to the margin [m].
SAME_PLANE = real(1.0e-4)
# Number of candidates that one triangle may need.
ROOM = 16


@func
def surface_radius(shapes: Shapes, world: Int32, core: Core, surface: Int32) -> real:
    """Radius by which a surface's triangles are rounded [m]: its margin; 0 against spheres, as in Bullet."""
    return 0.0 if core.kind == SPHERE else shapes.shape_margin[world, surface]


@func
def region_around(
    shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, surface: Int32, max_distance: real
) -> Region:
    """Region of a surface within `max_distance`, plus the surface's margin, of the bounds of a shape."""
    to_surface = wp.transpose(pairs.shape_frame[world, surface])
    turn = to_surface * pairs.shape_frame[world, shape]
    center = turn * local_center(shapes, shape) + to_surface * (
        pairs.shape_position[world, shape] - pairs.shape_position[world, surface]
    )
    more = max_distance + shapes.shape_margin[world, surface]
    extents = local_extents(shapes, world, shape)
    if shapes.shape_kind[shape] != SPHERE:
        extents = magnitudes(turn) * extents
    extents += Vector3(more, more, more)
    return region_of(shapes, world, surface, center - extents, center + extents)


@func
def mark_flat(pairs: Pairs, world: Int32, first: Int32, last: Int32, normal: Vector3):
    """Mark which candidates of a triangle are on its face."""
    for row in range(first, last):
        along = wp.dot(pairs.candidate[world, row].normal, normal)
        pairs.candidate[world, row].on_face = Int32(wp.abs(along) >= ON_FACE)


@shared_func
def drop_inner_edges(candidates: CandidateRows, world: Int32, count: Int32, thickness: real) -> Int32:
    """Drop candidates at edges that lie in the plane of a face with another one; returns the number left.

    The face carries the contact. The edge, as a candidate of a triangle in the same plane or beyond the end
    of the face, would only push sideways.
    """
    kept = Int32(0)
    for row in range(count):
        needed = Int32(1)
        if candidates[world, row].on_face == 0:
            point = candidates[world, row].point
            for other in range(count):
                if candidates[world, other].on_face == 1:
                    offset = point - candidates[world, other].point
                    height = wp.dot(offset, candidates[world, other].normal)
                    if wp.abs(height) <= thickness:
                        needed = Int32(0)
        if needed == 1:
            # Exchanged, not overwritten, because later rows are compared with all candidates.
            exchange(candidates, world, kept, row)
            kept += 1
    return kept


@func
def collide_surface(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    core: Core,
    max_distance: real,
    around: real,
) -> Int32:
    """Write the candidates of shape a, convex, on shape b, a mesh or height field; returns their number.

    `max_distance` is the largest distance of a contact [m]; triangles are tested within the distance `around`
    [m] from the bounds of a.
    """
    region = region_around(shapes, pairs, world, a, b, around)
    radius = surface_radius(shapes, world, core, b)
    thickness = 2.0 * radius + SAME_PLANE
    count = Int32(0)
    cursor = triangle_from(shapes, region, b, first_cursor(shapes, b))
    while cursor >= 0:
        triangle = triangle_core(pairs, world, b, triangle_corners(shapes, region, b, cursor), radius)
        found = collide_convex(
            shapes, pairs, world, a, b, core, triangle, max_distance, count,
            core.position - triangle.position, Vector3(0.0, 0.0, 0.0),
        )  # fmt: skip
        mark_flat(pairs, world, count, found, triangle_normal(triangle))
        count = found
        if count + ROOM > pairs.candidate.shape[1]:
            count = drop_inner_edges(pairs.candidate, world, count, thickness)
            count = keep_four(pairs.candidate, world, count)
        cursor = triangle_from(shapes, region, b, following_cursor(shapes, b, cursor))
    count = drop_inner_edges(pairs.candidate, world, count, thickness)
    return keep_four(pairs.candidate, world, count)


@func
def nearest_on_surface(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, core: Core, max_distance: real
):
    """Distance of shape a, convex, from shape b, a mesh or height field; normal on b and point on b.

    If the distance exceeds `max_distance`, the other results are meaningless.
    """
    region = region_around(shapes, pairs, world, a, b, max_distance)
    radius = surface_radius(shapes, world, core, b)
    rounding = core.radius + radius
    least = max_distance + 1.0
    best_normal = Vector3(0.0, 0.0, 1.0)
    best_point = core.position
    cursor = triangle_from(shapes, region, b, first_cursor(shapes, b))
    while cursor >= 0:
        triangle = triangle_core(pairs, world, b, triangle_corners(shapes, region, b, cursor), radius)
        limit = wp.min(least, max_distance)
        distance, normal, _on_a, on_b = nearest_or_deepest(
            shapes, pairs, world, core, triangle, limit + rounding, core.position - triangle.position,
            Vector3(0.0, 0.0, 0.0),
        )  # fmt: skip
        # Beyond the first the points are meaningless, and rounding may hide that from the second.
        if distance <= limit + rounding and distance - rounding <= limit:
            least = distance - rounding
            best_normal = normal
            best_point = on_b + normal * radius
            if least > 0.0 and shapes.shape_kind[b] == TRIANGLES:
                # Cursors of a mesh do not depend on the region, so the region may shrink.
                region = region_around(shapes, pairs, world, a, b, least)
        cursor = triangle_from(shapes, region, b, following_cursor(shapes, b, cursor))
    return least, best_normal, best_point
