"""Nearest points of two shapes at any distance, or deepest points if the shapes overlap."""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet, place_shapes
from carom.kernels.contact.candidates import add_candidate, exchange, flip_candidates
from carom.kernels.contact.narrow_phase import collide_simple, in_order
from carom.kernels.shapes.convex import nearest_or_deepest
from carom.kernels.shapes.cores import Core, core_of, sharpened
from carom.kernels.shapes.planes import collide_plane_deepest, with_sharp_edges
from carom.kernels.shapes.surfaces import nearest_on_surface
from carom.kernels.structs import NearestPair, Pairs, Searches, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, func, kernel, real
from carom.layouts.codes import BOX, CYLINDER, PLANE, TRIANGLES
from carom.layouts.contacts import PLACED, READINESS


@func
def nearest_of_cores(
    shapes: Shapes, pairs: Pairs, world: Int32, core_a: Core, core_b: Core, max_distance: real
) -> Int32:
    """Write the nearest candidate, as `nearest_in_order`, of two cores with their rounding."""
    rounding = core_a.radius + core_b.radius
    core_distance, normal, _on_a, on_b = nearest_or_deepest(
        shapes, pairs, world, core_a, core_b, max_distance + rounding, core_a.position - core_b.position,
        Vector3(0.0, 0.0, 0.0),
    )  # fmt: skip
    distance = core_distance - rounding
    # Beyond the second the points are meaningless, and rounding may hide that from the first.
    if distance > max_distance or core_distance > max_distance + rounding:
        return 0
    return add_candidate(pairs.candidate, world, 0, on_b + normal * core_b.radius, normal, distance)


@func
def nearest_convex(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, core_a: Core, max_distance: real
) -> Int32:
    """Write the nearest candidate, as `nearest_in_order`, if neither shape is a mesh or height field."""
    if core_a.kind == BOX and shapes.shape_kind[b] == PLANE:
        # If a face is flat on the plane, Bullet takes a particular one of its corners.
        return collide_plane_deepest(
            with_sharp_edges(core_a), shapes.vertex_position, pairs.shape_position[world, b],
            pairs.shape_frame[world, b] * shapes.shape_size[world, b], max_distance, pairs.candidate, world,
        )  # fmt: skip
    count = collide_simple(shapes, pairs, world, a, b, core_a, max_distance)
    if count >= 0:
        for row in range(1, count):
            if pairs.candidate[world, row].distance < pairs.candidate[world, 0].distance:
                exchange(pairs.candidate, world, 0, row)
        return wp.min(count, 1)
    return nearest_of_cores(shapes, pairs, world, core_a, core_of(shapes, pairs, world, b), max_distance)


@func
def nearest_in_order(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, max_distance: real
) -> Int32:
    """Write the nearest candidate, as `nearest`, of two shapes in the order of `narrow_phase.in_order`."""
    kind_a = shapes.shape_kind[a]
    kind_b = shapes.shape_kind[b]
    if kind_a == PLANE or kind_a >= TRIANGLES:
        return 0
    core_a = core_of(shapes, pairs, world, a)
    if kind_b >= TRIANGLES:
        distance, normal, point = nearest_on_surface(shapes, pairs, world, a, b, core_a, max_distance)
        if distance > max_distance:
            return 0
        return add_candidate(pairs.candidate, world, 0, point, normal, distance)
    return nearest_convex(shapes, pairs, world, a, b, core_a, max_distance)


@func
def nearest(shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, max_distance: real) -> Int32:
    """Write the nearest candidate of two shapes to row 0; returns 1, or 0 if they are too far apart.

    The normal points from b towards a. `max_distance` is the largest distance of interest [m].
    """
    first, second = in_order(shapes, a, b)
    count = nearest_in_order(shapes, pairs, world, first, second, max_distance)
    if first != a:
        flip_candidates(pairs.candidate, world, count)
    return count


@func
def is_rounded(kind: Int32) -> bool:
    """Whether the margin of shapes of a kind rounds their edges."""
    return kind == BOX or kind == CYLINDER


@func
def nearest_of_shapes(
    shapes: Shapes, pairs: Pairs, world: Int32, a: Int32, b: Int32, max_distance: real
) -> Int32:
    """As `nearest`, but boxes and cylinders have sharp edges, if the other shape is not a surface."""
    first, second = in_order(shapes, a, b)
    kind_a, kind_b = shapes.shape_kind[first], shapes.shape_kind[second]
    count = Int32(0)
    if kind_a == PLANE or kind_a >= TRIANGLES or kind_b >= TRIANGLES:
        count = nearest_in_order(shapes, pairs, world, first, second, max_distance)
    else:
        core_a = sharpened(core_of(shapes, pairs, world, first))
        if kind_b != PLANE and (is_rounded(kind_a) or is_rounded(kind_b)):
            core_b = sharpened(core_of(shapes, pairs, world, second))
            count = nearest_of_cores(shapes, pairs, world, core_a, core_b, max_distance)
        else:
            count = nearest_convex(shapes, pairs, world, first, second, core_a, max_distance)
    if first != a:
        flip_candidates(pairs.candidate, world, count)
    return count


@kernel
def closest_points_kernel(shapes: Shapes, pairs: Pairs, searches: Searches, count: Int32, max_distance: real):
    """Find the nearest points of given pairs of shapes up to `max_distance` [m], one pair after the other.

    `place_shapes_kernel` has computed the poses of the shapes.
    """
    world = wp.tid()
    found = Int32(0)
    for i in range(count):
        a = searches.search_first[world, i]
        b = searches.search_second[world, i]
        if boxes_meet(
            pairs.shape_lower[world, a],
            pairs.shape_upper[world, a],
            pairs.shape_lower[world, b],
            pairs.shape_upper[world, b],
            max_distance,
        ):
            if nearest(shapes, pairs, world, a, b, max_distance) == 1:
                searches.search_found[world, found] = pairs.candidate[world, 0]
                searches.search_pair[world, found] = i
                found += 1
    searches.search_count[world, 0] = found


@kernel
def nearest_pair_kernel(shapes: Shapes, pairs: Pairs, nearest_pair: NearestPair, first_world: Int32):
    """Find the nearest points of the nearest of some pairs of shapes; of equally near ones the first counts.

    Those are nearer than `NearestPair.asked_distance`.
    The shapes have been placed.
    """
    world = first_world + wp.tid()
    found = Int32(0)
    best = nearest_pair.asked_distance[0]
    for i in range(nearest_pair.asked_count[0]):
        a = nearest_pair.pair_first[i]
        b = nearest_pair.pair_second[i]
        # How deep those overlap that do is not bounded.
        reach = wp.max(best, real(0.0))
        if boxes_meet(
            pairs.shape_lower[world, a],
            pairs.shape_upper[world, a],
            pairs.shape_lower[world, b],
            pairs.shape_upper[world, b],
            reach,
        ):
            if nearest_of_shapes(shapes, pairs, world, a, b, reach) == 1:
                candidate = pairs.candidate[world, 0]
                if candidate.distance < best:
                    found = Int32(1)
                    best = candidate.distance
                    nearest_pair.world_point[world] = candidate.point
                    nearest_pair.world_normal[world] = candidate.normal
                    nearest_pair.world_distance[world] = candidate.distance
    nearest_pair.world_found[world] = found


@kernel
def place_shapes_kernel(settings: Settings, shapes: Shapes, state: State, pairs: Pairs):
    """Write the world poses and bounds of all shapes, for queries between steps."""
    world = wp.tid()
    place_shapes(shapes, state, settings, pairs, world)
    pairs.count_pairs[world, READINESS] = PLACED
