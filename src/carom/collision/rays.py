"""Rays against all shapes of a world."""

import warp as wp

from carom.collision.bounds import place_shapes
from carom.collision.hierarchy import BOUNDED, LEAVES, PLANES, build_hierarchy, leaf_start, next_node
from carom.collision.ray_solids import (
    MISS,
    ray_ball,
    ray_box,
    ray_capsule,
    ray_cylinder,
    ray_hull,
    ray_plane,
)
from carom.collision.ray_surfaces import box_entry, comes_after, inverse_way, ray_field, ray_mesh
from carom.model.codes import BOX, CAPSULE, CYLINDER, HULL, PLANE, SPHERE, TRIANGLES
from carom.model.contact_structs import Pairs, Shapes
from carom.model.real import Int32, Ints, Reals, Vector3, Vectors3, func, kernel, real
from carom.model.structs import Settings, State

# The group that rays belong to: shapes whose mask leaves it out are not hit.
RAY_GROUP = 1


@wp.struct
class Hit:
    """What a ray hit first."""

    shape: Int32  # -1: nothing
    fraction: real
    normal: Vector3  # in world axes


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

    The hit comes after `after`, or is there if `inclusive`, and not after `last`.
    """
    frame = pairs.shape_frame[world, shape]
    to_shape = wp.transpose(frame)
    origin = to_shape * (start - pairs.shape_position[world, shape])
    along = to_shape * way
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[shape]
    fraction = real(MISS)
    normal = Vector3(0.0, 0.0, 0.0)
    if kind == SPHERE:
        fraction, normal = ray_ball(origin, along, Vector3(0.0, 0.0, 0.0), size[0])
    elif kind == BOX:
        fraction, normal = ray_box(origin, along, size)
    elif kind == CAPSULE:
        fraction, normal = ray_capsule(origin, along, size[0], size[1])
    elif kind == CYLINDER:
        fraction, normal = ray_cylinder(origin, along, size[0], size[1])
    elif kind == PLANE:
        fraction, normal = ray_plane(origin, along, size)
    elif kind == HULL:
        fraction, normal = ray_hull(
            origin,
            along,
            shapes.face_plane,
            shapes.shape_first_face[shape],
            shapes.shape_face_count[shape],
            shapes.shape_margin[shape],
        )
    elif kind == TRIANGLES:
        fraction, normal = ray_mesh(shapes, shape, origin, along, after, inclusive, last)
    else:
        fraction, normal = ray_field(shapes, shape, origin, along, after, inclusive, last)
    if not comes_after(fraction, after, inclusive) or fraction > last:
        fraction = real(MISS)
    return fraction, frame * normal


@func
def is_visible(shapes: Shapes, shape: Int32, mask: Int32) -> bool:
    """Whether rays with a mask hit a shape."""
    link = shapes.shape_link[shape]
    return shapes.link_group[link] & mask != 0 and shapes.link_mask[link] & RAY_GROUP != 0


@func
def consider(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    shape: Int32,
    start: Vector3,
    way: Vector3,
    mask: Int32,
    before: Hit,
    separation: real,
    best: Hit,
) -> Hit:
    """The better one of the best hit so far and that on a shape, of those that come after `before`.

    Hits on one link that are at most `separation` apart count once.
    """
    after = before.fraction
    if before.shape >= 0:
        if shapes.shape_link[shape] == shapes.shape_link[before.shape]:
            after += wp.max(separation, 0.0)
    # Hits at the same place come in the order of the shapes.
    inclusive = shape > before.shape and after == before.fraction
    result = best
    if is_visible(shapes, shape, mask):
        fraction, normal = ray_shape(shapes, pairs, world, shape, start, way, after, inclusive, best.fraction)
        if fraction < best.fraction or (fraction == best.fraction and shape < best.shape):
            result.shape = shape
            result.fraction = fraction
            result.normal = normal
    return result


@func
def first_hit(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    start: Vector3,
    way: Vector3,
    mask: Int32,
    before: Hit,
    separation: real,
) -> Hit:
    """The first hit of a ray that comes after `before`."""
    best = Hit()
    best.shape = Int32(-1)
    best.fraction = real(MISS)
    leaf_count = pairs.count_pairs[world, LEAVES]
    count = pairs.count_pairs[world, BOUNDED]
    inverse = inverse_way(way)
    # What follows the bounded shapes are the planes: they make a last leaf, which has no bounds.
    node = Int32(1)
    searching = Int32(1)
    while searching == 1:
        first = count
        end = count
        if node == 0:
            end = count + pairs.count_pairs[world, PLANES]
            searching = Int32(0)
        elif (
            box_entry(
                start,
                inverse,
                pairs.node_lower[world, node],
                pairs.node_upper[world, node],
                wp.min(best.fraction, 1.0),
            )
            < MISS
        ):
            if node < leaf_count:
                node = 2 * node
                continue
            first = leaf_start(node - leaf_count, leaf_count, count)
            end = leaf_start(node - leaf_count + 1, leaf_count, count)
        for place in range(first, end):
            shape = pairs.shape_order[world, place]
            lower = pairs.shape_lower[world, shape]
            upper = pairs.shape_upper[world, shape]
            if box_entry(start, inverse, lower, upper, wp.min(best.fraction, 1.0)) < MISS:
                best = consider(shapes, pairs, world, shape, start, way, mask, before, separation, best)
        if node > 0:
            node = next_node(node)
    return best


@kernel
def prepare_rays_kernel(settings: Settings, shapes: Shapes, state: State, pairs: Pairs):
    """Poses, bounds and hierarchy of all shapes, for rays and other queries between steps."""
    world = wp.tid()
    place_shapes(shapes, state, settings, pairs, world)
    build_hierarchy(shapes, settings, pairs, world)


@kernel
def rays_kernel(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    starts: Vectors3,
    ends: Vectors3,
    mask: Int32,
    hit_number: Int32,
    separation: real,
    hit_shape: Ints,
    hit_fraction: Reals,
    hit_normal: Vectors3,
):
    """Cast one ray per thread; `prepare_rays_kernel` must have run.

    Args:
        shapes: All shapes.
        pairs: Poses and hierarchy.
        world: The world the rays are in.
        starts: Start of each ray.
        ends: End of each ray.
        mask: Groups of links that are hit.
        hit_number: 0 for the first hit, n for the n-th after it, in the order along the ray.
        separation: Later hits on the same link less than this fraction after one are passed over.
        hit_shape: For each ray the shape it hits, -1 for none.
        hit_fraction: Where, as a fraction of the ray; 1 for none.
        hit_normal: Normal there, in world axes; 0 for none.
    """
    ray = wp.tid()
    start = starts[ray]
    way = ends[ray] - start
    hit = Hit()
    hit.shape = Int32(-1)
    hit.fraction = real(-1.0)
    remaining = hit_number
    while remaining >= 0:
        hit = first_hit(shapes, pairs, world, start, way, mask, hit, separation)
        remaining -= 1
        if hit.shape < 0:
            remaining = Int32(-1)
    hit_shape[ray] = hit.shape
    hit_fraction[ray] = wp.min(hit.fraction, 1.0)
    hit_normal[ray] = hit.normal
