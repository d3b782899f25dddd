"""Broad phase: the pairs of shapes whose bounding boxes (AABBs) meet, sorted by shape rows.

Boxes meet if the gap between them is at most a margin (`bounds_margin`). Other pairs are near each other, and
listed as well: they matter for the order of the others (`overlaps.py`). Planes are few and meet almost all
shapes: each plane is compared with every shape. Each other shape is compared, by a traversal of the
hierarchy, with the shapes after it in the order of the leaves. So each pair is found once, and a traversal
takes about logarithmic time.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet, gap_between, look_ahead, place_shapes
from carom.kernels.contact.contact_margins import bounds_margin, is_part_of_compound
from carom.kernels.contact.filters import SELF_COLLISION, may_collide
from carom.kernels.contact.hierarchy import build_hierarchy, leaf_start, next_node
from carom.kernels.maths.min_max import maximum
from carom.kernels.structs import Contacts, Model, Pairs, Scratch, Settings, Shapes, State
from carom.kernels.types import Index2, Int32, func, real
from carom.layouts.contacts import (
    BOUNDED,
    CLOSE,
    CLOSE_WITH_MANIFOLD,
    KNOWN,
    LEAVES,
    MEETING,
    NEAR,
    PAIRS,
    PLANES,
    READINESS,
    STALE,
)


@func
def add_pair(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    nearness: Int32,
):
    """Add the pair of two shapes if they may collide; pairs beyond the capacity are only counted.

    `nearness` is one of CLOSE, CLOSE_WITH_MANIFOLD, MEETING.
    """
    if may_collide(shapes, model, settings, a, b):
        count = pairs.count_pairs[world, PAIRS]
        if count < pairs.pair_found.shape[1]:
            pairs.pair_found[world, count] = Index2(wp.min(a, b), wp.max(a, b))
            pairs.pair_found_nearness[world, count] = nearness
        pairs.count_pairs[world, PAIRS] = count + 1


@func
def close(shapes: Shapes, a: Int32, b: Int32) -> Int32:
    """The nearness of two shapes of which only the widened bounds overlap.

    Bullet has no manifold for them if one is a part of a compound.
    """
    if is_part_of_compound(shapes, a) or is_part_of_compound(shapes, b):
        return Int32(CLOSE)
    return Int32(CLOSE_WITH_MANIFOLD)


@func
def compare_in_leaf(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    start: Int32,
    leaf: Int32,
):
    """Add the pairs of shape `a` with the shapes of a leaf, from index `start` in `shape_order` on."""
    lower = pairs.shape_lower[world, a]
    upper = pairs.shape_upper[world, a]
    breaking = shapes.shape_breaking[a] + pairs.shape_motion[world, a]
    avoided = Int32(-1)
    if shapes.link_self_collision[shapes.shape_link[a]] & SELF_COLLISION == 0:
        avoided = shapes.shape_tree[a]
    first = wp.max(start, leaf_start(pairs, world, leaf))
    for place in range(first, leaf_start(pairs, world, leaf + 1)):
        b = pairs.shape_order[world, place]
        if shapes.shape_tree[b] == avoided:
            continue
        gap = gap_between(lower, upper, pairs.shape_lower[world, b], pairs.shape_upper[world, b])
        if gap <= maximum(breaking + pairs.shape_motion[world, b], real(NEAR)):
            meets = gap <= bounds_margin(shapes, pairs, world, a, b)
            if meets or gap <= NEAR:
                nearness = wp.where(meets, Int32(MEETING), close(shapes, a, b))
                add_pair(shapes, model, settings, pairs, world, a, b, nearness)


@func
def walk_from(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    place: Int32,
    own_leaf: Int32,
):
    """Add the pairs of the shape at index `place` of `shape_order` with all shapes at later indices."""
    a = pairs.shape_order[world, place]
    leaf_count = pairs.count_pairs[world, LEAVES]
    reach = maximum(shapes.shape_breaking[a] + pairs.shape_motion[world, a], real(NEAR))
    lower = pairs.shape_lower[world, a]
    upper = pairs.shape_upper[world, a]
    node = leaf_count + own_leaf
    while node > 0:
        if boxes_meet(lower, upper, pairs.node_lower[world, node], pairs.node_upper[world, node], reach):
            if node < leaf_count:
                node = 2 * node
                continue
            compare_in_leaf(shapes, model, settings, pairs, world, a, place + 1, node - leaf_count)
        node = next_node(node)


@func
def plane_pairs(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    plane: Int32,
    known: Int32,
):
    """Add the pairs of a plane with all shapes that reach below it or into the margin above it.

    If one of the two is new, that is not among the first `known` shapes, the pair is added in any case.
    """
    normal = pairs.shape_frame[world, plane] * shapes.shape_size[plane]
    along = wp.abs(normal)
    height = wp.dot(normal, pairs.shape_position[world, plane])
    for place in range(pairs.count_pairs[world, BOUNDED]):
        b = pairs.shape_order[world, place]
        lower = pairs.shape_lower[world, b]
        upper = pairs.shape_upper[world, b]
        nearest = 0.5 * (wp.dot(normal, lower + upper) - wp.dot(along, upper - lower)) - height
        if nearest <= bounds_margin(shapes, pairs, world, plane, b):
            add_pair(shapes, model, settings, pairs, world, plane, b, MEETING)
        elif wp.max(plane, b) >= known:
            add_pair(shapes, model, settings, pairs, world, plane, b, CLOSE_WITH_MANIFOLD)


@func
def sort_pairs(settings: Settings, pairs: Pairs, world: Int32):
    """Sort the pairs by first, then by second shape: their order must not depend on the traversal."""
    count = wp.min(pairs.count_pairs[world, PAIRS], pairs.pair_shapes.shape[1])
    for shape in range(settings.shape_count):
        pairs.shape_pair_end[world, shape] = 0
    for i in range(count):
        a = pairs.pair_found[world, i][0]
        pairs.shape_pair_end[world, a] = pairs.shape_pair_end[world, a] + 1
    total = Int32(0)
    for shape in range(settings.shape_count):
        size = pairs.shape_pair_end[world, shape]
        pairs.shape_pair_end[world, shape] = total
        total += size
    for i in range(count):
        pair = pairs.pair_found[world, i]
        place = pairs.shape_pair_end[world, pair[0]]
        pairs.shape_pair_end[world, pair[0]] = place + 1
        pairs.pair_shapes[world, place] = pair
        pairs.pair_nearness[world, place] = pairs.pair_found_nearness[world, i]
    # Insertion sort by second shape, as few pairs share a first shape. It cannot be part of the loop above:
    # until this loop ends, some rows of `pair_shapes` are left over from an earlier step.
    for i in range(1, count):
        pair = pairs.pair_shapes[world, i]
        nearness = pairs.pair_nearness[world, i]
        place = i + 0
        searching = place > 0
        while searching:
            before = pairs.pair_shapes[world, place - 1]
            searching = before[0] == pair[0] and before[1] > pair[1]
            if searching:
                pairs.pair_shapes[world, place] = before
                pairs.pair_nearness[world, place] = pairs.pair_nearness[world, place - 1]
                place -= 1
                searching = place > 0
        pairs.pair_shapes[world, place] = pair
        pairs.pair_nearness[world, place] = nearness


@func
def find_pairs(
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    settings: Settings,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
):
    """Find and sort the pairs of shapes whose bounds meet and that may collide, from the link poses."""
    for shape in range(settings.shape_count):
        pairs.shape_motion[world, shape] = look_ahead(shapes, model, settings, state, scratch, world, shape)
    place_shapes(shapes, state, settings, pairs, world)
    find_pairs_of_placed(shapes, model, settings, contacts, pairs, world)


@func
def find_pairs_of_placed(
    shapes: Shapes, model: Model, settings: Settings, contacts: Contacts, pairs: Pairs, world: Int32
):
    """Do what `find_pairs` does, with the poses and bounds of all shapes already written."""
    build_hierarchy(shapes, settings, pairs, world)
    pairs.count_pairs[world, READINESS] = STALE
    pairs.count_pairs[world, PAIRS] = 0
    leaf_count = pairs.count_pairs[world, LEAVES]
    count = pairs.count_pairs[world, BOUNDED]
    for place in range(count, count + pairs.count_pairs[world, PLANES]):
        plane = pairs.shape_order[world, place]
        plane_pairs(shapes, model, settings, pairs, world, plane, contacts.count_contacts[world, KNOWN])
    for leaf in range(leaf_count):
        for place in range(leaf_start(pairs, world, leaf), leaf_start(pairs, world, leaf + 1)):
            walk_from(shapes, model, settings, pairs, world, place, leaf)
    sort_pairs(settings, pairs, world)
