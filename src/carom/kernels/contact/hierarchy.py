"""Bounding volume hierarchy over the bounded shapes of a world, built anew whenever it is used.

Shapes are sorted along a space-filling curve (Morton codes); a leaf holds a few neighbours in that order.
The nodes form a complete binary tree: node 1 is the root, 2n and 2n + 1 are the children of n, and the
leaves are the last `leaf_count` nodes. So only bounds are stored, a traversal needs no stack, and the result
depends on the present bounds only. Sizes of shapes may differ freely: a large shape only widens the nodes
above it.
"""

import warp as wp

from carom.kernels.contact.bounds import UNBOUNDED, is_bounded
from carom.kernels.contact.contact_margins import most_ahead
from carom.kernels.maths.min_max import greatest_entry, lower_corner, maximum, upper_corner
from carom.kernels.structs import Pairs, Settings, Shapes
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.contacts import BOUNDED, FEW_SHAPES, LEAF_LENGTH, LEAVES, PLANES, RADIX

# Maximum number of shapes in a leaf, if there are several leaves.
LEAF_SIZE = 4
# Cells of the curve along each axis.
CURVE_CELLS = real(1024.0)
# The curve covers a window of this many mean deviations on each side of the mean of the shapes' centres.
SPREAD = real(4.0)
# The window is computed this many times, each time without the shapes outside the previous window. So bodies
# that fall for ever or fly away do not coarsen the cells of the others.
TRIMMINGS = 4


@func
def next_node(node: Int32) -> Int32:
    """Node to visit after a node and its whole subtree; 0 after the last."""
    following = node + 1
    while following & 1 == 0:
        following = following >> 1
    if following == 1:
        return 0
    return following


@func
def spread_bits(value: Int32) -> Int32:
    """Spread the ten lowest bits of a number to every third bit."""
    x = value & 1023
    x = (x | (x << 16)) & 50331903
    x = (x | (x << 8)) & 50393103
    x = (x | (x << 4)) & 51130563
    return (x | (x << 2)) & 153391689


@func
def is_placed(pairs: Pairs, world: Int32, shape: Int32) -> bool:
    """Whether the pose of a shape is finite: then its bounds are not empty."""
    return pairs.shape_lower[world, shape][0] <= pairs.shape_upper[world, shape][0]


@func
def gather_shapes(shapes: Shapes, settings: Settings, pairs: Pairs, world: Int32):
    """List the shapes whose pose is finite: first the bounded shapes, then the planes."""
    count = Int32(0)
    planes = Int32(0)
    for shape in range(settings.shape_count):
        if is_placed(pairs, world, shape):
            if is_bounded(shapes, shape):
                pairs.shape_order[world, count] = shape
                count += 1
            else:
                pairs.shape_sorted[world, planes] = shape
                planes += 1
    for i in range(planes):
        pairs.shape_order[world, count + i] = pairs.shape_sorted[world, i]
    pairs.count_pairs[world, BOUNDED] = count
    pairs.count_pairs[world, PLANES] = planes


@func
def double_center(pairs: Pairs, world: Int32, shape: Int32) -> Vector3:
    """Twice the centre of a shape's bounds."""
    return pairs.shape_lower[world, shape] + pairs.shape_upper[world, shape]


@func
def write_codes(pairs: Pairs, world: Int32, count: Int32):
    """Write the Morton code of each listed shape, its place along the curve."""
    window_center = Vector3(0.0, 0.0, 0.0)
    window = Vector3(UNBOUNDED, UNBOUNDED, UNBOUNDED)
    trimming = Int32(0)
    while trimming < TRIMMINGS:
        inside = real(0.0)
        mean = Vector3(0.0, 0.0, 0.0)
        for i in range(count):
            center = double_center(pairs, world, pairs.shape_order[world, i])
            if within(center - window_center, window):
                mean += center
                inside += 1.0
        mean = mean / maximum(inside, 1.0)
        deviation = Vector3(0.0, 0.0, 0.0)
        for i in range(count):
            center = double_center(pairs, world, pairs.shape_order[world, i])
            if within(center - window_center, window):
                deviation += wp.abs(center - mean)
        window = deviation * (SPREAD / maximum(inside, 1.0)) + Vector3(1.0e-9, 1.0e-9, 1.0e-9)
        window_center = mean
        trimming += 1
    # Cells are cubes: otherwise shapes at almost the same height would be sorted by tiny height differences.
    scale = 1.0 / greatest_entry(window)
    for i in range(count):
        shape = pairs.shape_order[world, i]
        place = (double_center(pairs, world, shape) - window_center) * scale
        pairs.shape_code[world, shape] = (
            spread_bits(curve_cell(place[0]))
            | (spread_bits(curve_cell(place[1])) << 1)
            | (spread_bits(curve_cell(place[2])) << 2)
        )


@func
def within(offset: Vector3, window: Vector3) -> bool:
    """Whether an offset from the centre of a window is inside the window."""
    return (
        wp.abs(offset[0]) <= window[0] and wp.abs(offset[1]) <= window[1] and wp.abs(offset[2]) <= window[2]
    )


@func
def curve_cell(place: real) -> Int32:
    """Cell of a coordinate between -1 and 1 along an axis; coordinates outside get the nearest cell."""
    return Int32(wp.clamp((place + 1.0) * 0.5 * CURVE_CELLS, 0.0, CURVE_CELLS - 1.0))


@func
def sort_by_code(pairs: Pairs, world: Int32, count: Int32):
    """Sort `shape_order` by code, equal codes by shape (radix sort)."""
    shift = Int32(0)
    while shift < 32:
        for bucket in range(RADIX):
            pairs.bucket_end[world, bucket] = 0
        for i in range(count):
            bucket = (pairs.shape_code[world, pairs.shape_order[world, i]] >> shift) & (RADIX - 1)
            pairs.bucket_end[world, bucket] = pairs.bucket_end[world, bucket] + 1
        total = Int32(0)
        for bucket in range(RADIX):
            size = pairs.bucket_end[world, bucket]
            pairs.bucket_end[world, bucket] = total
            total += size
        for i in range(count):
            shape = pairs.shape_order[world, i]
            bucket = (pairs.shape_code[world, shape] >> shift) & (RADIX - 1)
            place = pairs.bucket_end[world, bucket]
            pairs.bucket_end[world, bucket] = place + 1
            pairs.shape_sorted[world, place] = shape
        for i in range(count):
            pairs.shape_order[world, i] = pairs.shape_sorted[world, i]
        shift += 8


@func
def leaf_start(pairs: Pairs, world: Int32, leaf: Int32) -> Int32:
    """First index in `shape_order` of a leaf; leaves are counted from 0."""
    return wp.min(leaf * pairs.count_pairs[world, LEAF_LENGTH], pairs.count_pairs[world, BOUNDED])


@func
def bound_leaves(shapes: Shapes, pairs: Pairs, world: Int32, leaf_count: Int32):
    """Write the bounds of the leaves, widened by how far their shapes may meet others."""
    for leaf in range(leaf_count):
        lower = Vector3(UNBOUNDED, UNBOUNDED, UNBOUNDED)
        upper = -lower
        for i in range(leaf_start(pairs, world, leaf), leaf_start(pairs, world, leaf + 1)):
            shape = pairs.shape_order[world, i]
            ahead = most_ahead(shapes, pairs, world, shape)
            margin = Vector3(ahead, ahead, ahead)
            lower = lower_corner(lower, pairs.shape_lower[world, shape] - margin)
            upper = upper_corner(upper, pairs.shape_upper[world, shape] + margin)
        pairs.node_lower[world, leaf_count + leaf] = lower
        pairs.node_upper[world, leaf_count + leaf] = upper


@func
def build_hierarchy(shapes: Shapes, settings: Settings, pairs: Pairs, world: Int32):
    """Sort the bounded shapes, then write the bounds of all nodes, from the leaves up to the root."""
    gather_shapes(shapes, settings, pairs, world)
    count = pairs.count_pairs[world, BOUNDED]
    leaf_count = Int32(1)
    if count > FEW_SHAPES:
        while leaf_count * LEAF_SIZE < count:
            leaf_count *= 2
    pairs.count_pairs[world, LEAVES] = leaf_count
    pairs.count_pairs[world, LEAF_LENGTH] = (count + leaf_count - 1) // leaf_count
    if leaf_count > 1:
        write_codes(pairs, world, count)
        sort_by_code(pairs, world, count)
    bound_leaves(shapes, pairs, world, leaf_count)
    node = leaf_count - 1
    while node >= 1:
        pairs.node_lower[world, node] = lower_corner(
            pairs.node_lower[world, 2 * node], pairs.node_lower[world, 2 * node + 1]
        )
        pairs.node_upper[world, node] = upper_corner(
            pairs.node_upper[world, 2 * node], pairs.node_upper[world, 2 * node + 1]
        )
        node -= 1
