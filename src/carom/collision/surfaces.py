"""Convex shapes on triangle meshes and height fields."""

import warp as wp

from carom.collision.bounds import local_center, local_extents, magnitudes
from carom.collision.candidates import candidate_distance, candidate_normal, keep_four
from carom.collision.convex import FLAT_ON, nearest_or_deepest, touch_convex
from carom.collision.cores import Core
from carom.collision.triangles import (
    Region,
    first_cursor,
    following_cursor,
    region_of,
    triangle_core,
    triangle_corners,
    triangle_from,
)
from carom.model.codes import SPHERE, TRIANGLES
from carom.model.contact_structs import Pairs, Shapes
from carom.model.real import Int32, Vector3, func, real

# Room that one triangle may need among the candidates.
ROOM = 16


@func
def surface_radius(shapes: Shapes, core: Core, surface: Int32) -> real:
    """Rounding of a surface's triangles: its margin, but as in Bullet none against balls."""
    if core.kind == SPHERE:
        return 0.0
    return shapes.shape_margin[surface]


@func
def region_around(
    shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32, surface: Int32, reach: real
) -> Region:
    """The region of a surface that is within reach of a shape."""
    to_surface = wp.transpose(pairs.shape_frame[world, surface])
    turn = to_surface * pairs.shape_frame[world, shape]
    center = turn * local_center(shapes, shape) + to_surface * (
        pairs.shape_position[world, shape] - pairs.shape_position[world, surface]
    )
    more = reach + shapes.shape_margin[surface]
    extents = magnitudes(turn) * local_extents(shapes, shape) + Vector3(more, more, more)
    return region_of(shapes, surface, center - extents, center + extents)


@func
def only_edge(pairs: Pairs, world: Int32, row: Int32, normal: Vector3) -> bool:
    """Whether a candidate is not on the face of a triangle but at its edge, and does not touch yet.

    Such contacts would stop what slides from one triangle of a flat surface to the next.
    """
    along = wp.dot(candidate_normal(pairs.candidate_terms, world, row), normal)
    return wp.abs(along) < FLAT_ON and candidate_distance(pairs.candidate_terms, world, row) > 0.0


@func
def triangle_normal(core: Core) -> Vector3:
    """Unit normal of a triangle."""
    a = Vector3(core.frame[0, 0], core.frame[1, 0], core.frame[2, 0])
    b = Vector3(core.frame[0, 1], core.frame[1, 1], core.frame[2, 1])
    c = Vector3(core.frame[0, 2], core.frame[1, 2], core.frame[2, 2])
    return wp.normalize(wp.cross(b - a, c - a))


@func
def touch_surface(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, core: Core, reach: real
) -> Int32:
    """Candidates of shape a, convex, on shape b, a mesh or height field; returns their number."""
    region = region_around(shapes, pairs, world, a, b, reach)
    radius = surface_radius(shapes, core, b)
    count = Int32(0)
    cursor = triangle_from(shapes, region, b, first_cursor(shapes, b))
    while cursor >= 0:
        triangle = triangle_core(pairs, world, b, triangle_corners(shapes, region, b, cursor), radius)
        found = touch_convex(shapes, pairs, world, a, b, core, triangle, reach, count)
        normal = triangle_normal(triangle)
        for row in range(count, found):
            if not only_edge(pairs, world, row, normal):
                pairs.candidate_terms[world, count] = pairs.candidate_terms[world, row]
                count += 1
        if count + ROOM > pairs.candidate_terms.shape[1]:
            count = keep_four(pairs.candidate_terms, world, count)
        cursor = triangle_from(shapes, region, b, following_cursor(shapes, b, cursor))
    return keep_four(pairs.candidate_terms, world, count)


@func
def nearest_on_surface(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, core: Core, reach: real
):
    """Distance of shape a, convex, from shape b, a mesh or height field; normal on b and point on b.

    If the distance is more than `reach` the rest means nothing.
    """
    region = region_around(shapes, pairs, world, a, b, reach)
    radius = surface_radius(shapes, core, b)
    rounding = core.radius + radius
    least = reach + 1.0
    best_normal = Vector3(0.0, 0.0, 1.0)
    best_point = core.position
    cursor = triangle_from(shapes, region, b, first_cursor(shapes, b))
    while cursor >= 0:
        triangle = triangle_core(pairs, world, b, triangle_corners(shapes, region, b, cursor), radius)
        distance, normal, _on_a, on_b = nearest_or_deepest(
            shapes, pairs, world, core, triangle, wp.min(least, reach) + rounding
        )
        if distance - rounding <= wp.min(least, reach):
            least = distance - rounding
            best_normal = normal
            best_point = on_b + normal * radius
            if least > 0.0 and shapes.shape_kind[b] == TRIANGLES:
                # Cursors of a mesh do not depend on the region, which may shrink.
                region = region_around(shapes, pairs, world, a, b, least)
        cursor = triangle_from(shapes, region, b, following_cursor(shapes, b, cursor))
    return least, best_normal, best_point
