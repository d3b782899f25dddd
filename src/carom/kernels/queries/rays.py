"""Ray tests against all shapes of a world."""

import warp as wp

from carom.kernels.contact.bounds import place_shapes
from carom.kernels.contact.hierarchy import build_hierarchy, leaf_start, next_node
from carom.kernels.queries.ray_grazing import is_convex, may_graze, ray_grazing, ray_rounded
from carom.kernels.queries.ray_hulls import ray_hull
from carom.kernels.queries.ray_packets import (
    LANES,
    NOWHERE,
    Packet,
    any_within,
    lane_of,
    length_within,
    meets,
    packet_of,
    way_of,
    with_lane,
)
from carom.kernels.queries.ray_solids import (
    MISS,
    ray_ball,
    ray_box,
    ray_capsule,
    ray_cylinder,
    ray_ellipsoid,
    ray_plane,
)
from carom.kernels.queries.ray_surfaces import comes_after, ray_field, ray_mesh
from carom.kernels.structs import Pairs, Places, Rays, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, Vector4, func, kernel, real
from carom.layouts.codes import (
    BOX,
    CAPSULE,
    CYLINDER,
    ELLIPSOID_FACETS,
    HULL,
    PLANE,
    ROUNDED,
    SPHERE,
    TRIANGLES,
)
from carom.layouts.contacts import BOUNDED, IN_HIERARCHY, LEAVES, PLANES, READINESS

# Collision group of rays: links whose mask excludes this group are not hit.
RAY_GROUP = 1


@func
def ray_shape(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    shape: Int32,
    start: Vector3,
    way: Vector3,
    after: real,
    inclusive: bool,
    last: real,
):
    """Fraction at which a ray hits a shape, and the normal in world axes.

    Only hits at a fraction greater than `after` (or equal to it, if `inclusive`) and up to `last` count.
    """
    position = pairs.shape_position[world, shape]
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[world, shape]
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    frame = pairs.shape_frame[world, shape]
    if kind == SPHERE:
        fraction, normal = ray_ball(start, way, position, size[0])
    elif kind == PLANE:
        fraction, normal = ray_plane(start - position, way, frame * size)
    else:
        to_shape = wp.transpose(frame)
        origin = to_shape * (start - position)
        along = to_shape * way
        if kind == BOX:
            fraction, normal = ray_box(origin, along, size)
        elif kind == CAPSULE:
            fraction, normal = ray_capsule(origin, along, size[0], size[1])
        elif kind == CYLINDER:
            fraction, normal = ray_cylinder(origin, along, size[0], size[1])
        elif kind == HULL:
            fraction, normal = ray_hull(
                origin, along, shapes.face_plane, shapes.shape_first_face[shape],
                shapes.shape_face_count[shape], shapes.shape_margin[world, shape],
            )  # fmt: skip
            if shapes.shape_columns[shape] == ROUNDED:
                # Not before the ray enters the polyhedron around it, if it begins outside of that.
                entry = wp.where(fraction <= 1.0, fraction, real(0.0))
                fraction, normal = ray_rounded(shapes, world, shape, origin, along, entry)
            elif shapes.shape_columns[shape] == ELLIPSOID_FACETS:
                fraction, normal = ray_ellipsoid(origin, along, size)
        elif kind == TRIANGLES:
            fraction, normal = ray_mesh(shapes, shape, origin, along, after, inclusive, last)
        else:
            fraction, normal = ray_field(shapes, world, shape, origin, along, after, inclusive, last)
        normal = frame * normal
    # Facets of an ellipsoid lie within it.
    has_margin = is_convex(kind) and not (kind == HULL and shapes.shape_columns[shape] == ELLIPSOID_FACETS)
    if has_margin and may_graze(fraction, normal, way):
        to_frame = wp.transpose(frame)
        at, outward = ray_grazing(shapes, world, shape, to_frame * (start - position), to_frame * way, last)
        if at < fraction:
            fraction = at
            normal = frame * outward
    if not comes_after(fraction, after, inclusive) or fraction > last:
        fraction = real(MISS)
    return fraction, normal


@func
def is_visible(shapes: Shapes, shape: Int32, mask: Int32) -> bool:
    """Whether rays with a mask can hit a shape."""
    link = shapes.shape_link[shape]
    return shapes.link_group[link] & mask != 0 and shapes.link_mask[link] & RAY_GROUP != 0


@func
def hit_shape(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    shape: Int32,
    rays: Rays,
    packet: Packet,
    given_limit: Vector4,
    lengths: Vector4,
    separation: real,
) -> Vector4:
    """Test the rays that meet the bounds of a shape, and keep each hit that is nearer than the best so far.

    Hits on one link that are at most `separation` apart (a fraction of the ray) count once.

    Returns:
        New limits of the rays: the fractions of the best hits.
    """
    limit = given_limit
    for ray in range(packet.first, packet.end):
        lane = ray - packet.first
        if lane_of(lengths, lane) >= 0.0:
            last = rays.ray_last_shape[ray]
            after = rays.ray_last_fraction[ray]
            if last >= 0:
                if shapes.shape_link[shape] == shapes.shape_link[last]:
                    after += wp.max(separation, 0.0)
            # Hits at the same fraction are in the order of the shapes.
            inclusive = shape > last and after == rays.ray_last_fraction[ray]
            start = rays.ray_start[ray]
            way = way_of(rays, ray)
            best = lane_of(limit, lane)
            known = rays.ray_shape[ray]
            fraction, normal = ray_shape(shapes, pairs, world, shape, start, way, after, inclusive, best)
            if fraction < best or (fraction == best and (known < 0 or shape < known)):
                limit = with_lane(limit, lane, fraction)
                rays.ray_shape[ray] = shape
                rays.ray_normal[ray] = normal
    return limit


@func
def next_leaf(
    pairs: Pairs, world: Int32, packet: Packet, limit: Vector4, leaf_count: Int32, node: Int32
) -> Int32:
    """First leaf, from `node` on, that any of the rays meets; 0 if there is none."""
    result = node
    while result > 0:
        if meets(packet, limit, pairs.node_lower[world, result], pairs.node_upper[world, result]):
            if result >= leaf_count:
                return result
            result = 2 * result
        else:
            result = next_node(result)
    return result


@func
def first_hits(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    rays: Rays,
    packet: Packet,
    given_limit: Vector4,
    mask: Int32,
    separation: real,
) -> Vector4:
    """Write shape and normal of the first hits of four rays to `rays`; returns the fractions."""
    limit = given_limit
    leaf_count = pairs.count_pairs[world, LEAVES]
    count = pairs.count_pairs[world, BOUNDED]
    # Planes are tested first, because most rays that hit nothing else hit the ground.
    first = count
    end = count + pairs.count_pairs[world, PLANES]
    node, searching = Int32(1), Int32(1)
    while searching == 1:
        for place in range(first, end):
            shape = pairs.shape_order[world, place]
            lower = pairs.shape_lower[world, shape]
            upper = pairs.shape_upper[world, shape]
            lengths = length_within(packet, limit, lower, upper)
            if lower[0] <= upper[0] and any_within(lengths):
                if is_visible(shapes, shape, mask):
                    limit = hit_shape(shapes, pairs, world, shape, rays, packet, limit, lengths, separation)
        node = next_leaf(pairs, world, packet, limit, leaf_count, node)
        searching = wp.min(node, 1)
        first = leaf_start(pairs, world, node - leaf_count)
        end = leaf_start(pairs, world, node - leaf_count + 1)
        if searching == 1:
            node = next_node(node)
    return limit


@func
def cast_packet(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    rays: Rays,
    packet: Packet,
    limit: Vector4,
    mask: Int32,
    hit_number: Int32,
    separation: real,
):
    """Write shape, normal and fraction of hit number `hit_number`, counted from 0, of four rays."""
    for ray in range(packet.first, packet.end):
        rays.ray_shape[ray] = -1
        rays.ray_fraction[ray] = NOWHERE
    looking = limit
    fractions = limit
    remaining = hit_number
    while remaining >= 0:
        found = Int32(0)
        for ray in range(packet.first, packet.end):
            rays.ray_last_shape[ray] = rays.ray_shape[ray]
            rays.ray_last_fraction[ray] = rays.ray_fraction[ray]
            rays.ray_shape[ray] = -1
        fractions = first_hits(shapes, pairs, world, rays, packet, looking, mask, separation)
        for ray in range(packet.first, packet.end):
            lane = ray - packet.first
            rays.ray_fraction[ray] = lane_of(fractions, lane)
            if rays.ray_shape[ray] < 0:
                looking = with_lane(looking, lane, NOWHERE)
            else:
                found = Int32(1)
        # If no ray has a hit in this pass, no ray has any further hits.
        remaining = wp.where(found == 1, remaining - 1, Int32(-1))


@func
def tell_hit(shapes: Shapes, places: Places, rays: Rays, ray: Int32):
    """Write body, link and position of a ray's hit for users, from its shape and fraction."""
    shape = rays.ray_shape[ray]
    if shape >= 0:
        row = shapes.shape_link[shape]
        rays.ray_body[ray] = places.place_body[row]
        rays.ray_link[ray] = places.place_link[row]
        rays.ray_position[ray] = rays.ray_start[ray] + way_of(rays, ray) * rays.ray_fraction[ray]
    else:
        rays.ray_body[ray] = -1
        rays.ray_link[ray] = -1
        rays.ray_fraction[ray] = 1.0
        rays.ray_position[ray] = Vector3(0.0, 0.0, 0.0)
        rays.ray_normal[ray] = Vector3(0.0, 0.0, 0.0)


@kernel
def prepare_rays_kernel(settings: Settings, shapes: Shapes, state: State, pairs: Pairs, first_world: Int32):
    """Write poses, bounds and hierarchy of all shapes, for rays and other queries between steps."""
    world = first_world + wp.tid()
    place_shapes(shapes, state, settings, pairs, world)
    build_hierarchy(shapes, settings, pairs, world)
    pairs.count_pairs[world, READINESS] = IN_HIERARCHY


@kernel
def rays_kernel(
    shapes: Shapes,
    pairs: Pairs,
    places: Places,
    rays: Rays,
    first_world: Int32,
    count: Int32,
    threads: Int32,
    mask: Int32,
    hit_number: Int32,
    separation: real,
):
    """Cast the rays of several worlds, `count` in each; rays are in the order of the worlds.

    The kernel has `threads` threads for each world. `prepare_rays_kernel` must have run for these worlds.
    Rays hit links of the collision groups in `mask`. Hit number 0 is the first, n the n-th after it, in the
    order along the ray; after a hit, further hits on the same link within the fraction `separation` of the
    ray are skipped.
    """
    world = first_world + wp.tid() // threads
    start = world * count
    first = start + LANES * (wp.tid() % threads)
    while first < start + count:
        packet, limit = packet_of(rays, first, start + count)
        cast_packet(shapes, pairs, world, rays, packet, limit, mask, hit_number, separation)
        for ray in range(packet.first, packet.end):
            tell_hit(shapes, places, rays, ray)
        first += LANES * threads
