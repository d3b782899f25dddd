"""Neighbour list (Verlet list): the pairs of shapes that may meet soon, which serves several substeps.

It has the pairs that may collide and whose bounds are at most a *slack* farther apart than pairs that count
as near. While no bound has moved by more than half the slack, all near pairs are in the list; where shapes
look ahead, what they look farther by counts as motion. So most steps need no hierarchy, no filters and no
sort. Which pairs are selected does not depend on when the list was made.

In motion so fast that a list would not last, it is made anew in each substep, without slack. But among few
shapes it then has all pairs that may collide, and serves any other world whose steps are taken in between.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet, gap_between, is_bounded
from carom.kernels.contact.contact_margins import most_ahead
from carom.kernels.contact.filters import SELF_COLLISION, may_collide
from carom.kernels.contact.hierarchy import build_hierarchy, is_placed, leaf_start, next_node
from carom.kernels.maths.min_max import greatest_entry, maximum, upper_corner
from carom.kernels.structs import Model, Pairs, Settings, Shapes
from carom.kernels.types import Index2, Int32, called_func, func, real
from carom.layouts.contacts import (
    BOUNDED,
    FEW_SHAPES,
    LEAVES,
    LIST_AGE,
    LIST_FILTER,
    LIST_KIND,
    LISTED,
    NO_LIST,
    PLANES,
)

# Kinds of lists: without slack, with it, and of all pairs.
NARROW, WIDE, COMPLETE = 0, 1, 2
# Slack of a wide list [m].
SLACK = real(0.02)
# Slack of a complete list: less than bounds change when a shape without a pose gets one [m].
ENDLESS = real(1e17)
# Substeps after which a complete list is made anew, as a wide one may be enough now.
LONGEST_LIFE = 256
# Pairs of one shape that are sorted as they are inserted; more are sorted by both shapes in linear time.
MANY_OF_ONE = 64
# Substeps that a wide list has to last, at the present speed.
MIN_LIFE = real(4.0)


@func
def displacement(settings: Settings, pairs: Pairs, world: Int32) -> real:
    """Largest change of a bound since the list was made [m]."""
    farthest = real(0.0)
    for shape in range(settings.shape_count):
        lower = wp.abs(pairs.shape_lower[world, shape] - pairs.shape_listed_lower[world, shape])
        upper = wp.abs(pairs.shape_upper[world, shape] - pairs.shape_listed_upper[world, shape])
        farthest = maximum(farthest, greatest_entry(upper_corner(lower, upper)))
    return farthest


@func
def farther_ahead(settings: Settings, pairs: Pairs, world: Int32) -> real:
    """By how much farther continuous detection looks ahead of a shape than when the list was made [m]."""
    farthest = real(0.0)
    if settings.looks_ahead != 0:
        for shape in range(settings.shape_count):
            more = pairs.shape_motion[world, shape] - pairs.shape_listed_motion[world, shape]
            farthest = maximum(farthest, more)
    return farthest


@func
def slack_of(kind: Int32) -> real:
    """Slack of a list: narrow, wide or complete."""
    return ENDLESS if kind == COMPLETE else real(kind) * SLACK


@called_func
def renew_list(shapes: Shapes, model: Model, settings: Settings, pairs: Pairs, world: Int32):
    """Make the list anew unless it holds; the number of its pairs may exceed the capacity."""
    age = pairs.count_pairs[world, LIST_AGE] + 1
    few = settings.shape_count <= FEW_SHAPES
    kind = Int32(NARROW)
    if pairs.count_pairs[world, LIST_FILTER] == 1 + settings.filter_both:
        moved = displacement(settings, pairs, world) + farther_ahead(settings, pairs, world)
        last = pairs.count_pairs[world, LIST_KIND]
        is_old = last == COMPLETE and age > LONGEST_LIFE
        if 2.0 * moved <= slack_of(last) and not is_old:
            pairs.count_pairs[world, LIST_AGE] = age
            return
        if 2.0 * MIN_LIFE * moved <= real(age) * SLACK:
            kind = Int32(WIDE)
        elif few:
            kind = Int32(COMPLETE)
    build_hierarchy(shapes, settings, pairs, world)
    count = list_pairs(shapes, model, settings, pairs, world, slack_of(kind))
    if kind != NARROW and count > pairs.listed_shapes.shape[1]:
        kind = Int32(NARROW)
        count = list_pairs(shapes, model, settings, pairs, world, real(0.0))
    for shape in range(settings.shape_count):
        pairs.shape_listed_lower[world, shape] = pairs.shape_lower[world, shape]
        pairs.shape_listed_upper[world, shape] = pairs.shape_upper[world, shape]
        pairs.shape_listed_motion[world, shape] = pairs.shape_motion[world, shape]
    pairs.count_pairs[world, LIST_AGE] = 0
    pairs.count_pairs[world, LIST_KIND] = kind
    pairs.count_pairs[world, LIST_FILTER] = 1 + settings.filter_both
    if count > pairs.listed_shapes.shape[1]:
        pairs.count_pairs[world, LIST_FILTER] = NO_LIST
        return
    sort_list(settings, pairs, world)


@func
def list_pairs(
    shapes: Shapes, model: Model, settings: Settings, pairs: Pairs, world: Int32, slack: real
) -> Int32:
    """List the pairs up to a slack, each once, in the order of the hierarchy; returns their number.

    Planes are few and meet almost all shapes: each is listed with every shape. The shapes of each leaf are
    compared, by a traversal of the hierarchy, with those after them in the order of the leaves. A traversal
    takes about logarithmic time.
    """
    pairs.count_pairs[world, LISTED] = 0
    count = pairs.count_pairs[world, BOUNDED]
    for place in range(count, count + pairs.count_pairs[world, PLANES]):
        a = pairs.shape_order[world, place]
        for b in range(settings.shape_count):
            if is_bounded(shapes, b) and is_placed(pairs, world, b):
                add_to_list(shapes, model, settings, pairs, world, a, b)
    for leaf in range(pairs.count_pairs[world, LEAVES]):
        walk_from(shapes, model, settings, pairs, world, leaf, slack)
    return pairs.count_pairs[world, LISTED]


@func
def walk_from(
    shapes: Shapes, model: Model, settings: Settings, pairs: Pairs, world: Int32, own_leaf: Int32, slack: real
):
    """List the shapes of a leaf with the near ones among those at later indices of `shape_order`."""
    leaf_count = pairs.count_pairs[world, LEAVES]
    start = leaf_start(pairs, world, own_leaf)
    end = leaf_start(pairs, world, own_leaf + 1)
    for place in range(start, end):
        compare_in_leaf(shapes, model, settings, pairs, world, place, place + 1, end, slack)
    node = leaf_count + own_leaf
    # Bounds of nodes are widened by look-ahead distances.
    lower = pairs.node_lower[world, node]
    upper = pairs.node_upper[world, node]
    node = next_node(node)
    while node > 0:
        node_lower = pairs.node_lower[world, node]
        node_upper = pairs.node_upper[world, node]
        if boxes_meet(lower, upper, node_lower, node_upper, settings.near + slack):
            if node < leaf_count:
                node = 2 * node
                continue
            leaf = node - leaf_count
            first = leaf_start(pairs, world, leaf)
            last = leaf_start(pairs, world, leaf + 1)
            for place in range(start, end):
                a = pairs.shape_order[world, place]
                own = settings.near + slack + most_ahead(shapes, pairs, world, a)
                if boxes_meet(
                    pairs.shape_lower[world, a], pairs.shape_upper[world, a], node_lower, node_upper, own
                ):
                    compare_in_leaf(shapes, model, settings, pairs, world, place, first, last, slack)
        node = next_node(node)


@func
def compare_in_leaf(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    place: Int32,
    first: Int32,
    last: Int32,
    slack: real,
):
    """List the shape at index `place` of `shape_order` with the near ones at indices [first, last)."""
    a = pairs.shape_order[world, place]
    lower = pairs.shape_lower[world, a]
    upper = pairs.shape_upper[world, a]
    ahead = most_ahead(shapes, pairs, world, a)
    avoided = Int32(-1)
    if shapes.link_self_collision[shapes.shape_link[a]] & SELF_COLLISION == 0:
        avoided = shapes.shape_tree[a]
    for other in range(first, last):
        b = pairs.shape_order[world, other]
        if shapes.shape_tree[b] == avoided:
            continue
        gap = gap_between(lower, upper, pairs.shape_lower[world, b], pairs.shape_upper[world, b])
        if gap <= slack + maximum(ahead + most_ahead(shapes, pairs, world, b), settings.near):
            add_to_list(shapes, model, settings, pairs, world, a, b)


@func
def add_to_list(
    shapes: Shapes, model: Model, settings: Settings, pairs: Pairs, world: Int32, a: Int32, b: Int32
):
    """List two shapes if they may collide; pairs beyond the capacity are only counted."""
    if may_collide(shapes, model, settings, a, b):
        count = pairs.count_pairs[world, LISTED]
        if count < pairs.listed_found.shape[1]:
            pairs.listed_found[world, count] = Index2(wp.min(a, b), wp.max(a, b))
        pairs.count_pairs[world, LISTED] = count + 1


@func
def distribute(settings: Settings, pairs: Pairs, world: Int32, side: Int32) -> Int32:
    """Sort the list by the first (0) or second (1) shape, in linear time; equal ones stay in order.

    Returns:
        The greatest number of pairs with the same shape there.
    """
    count = pairs.count_pairs[world, LISTED]
    for shape in range(settings.shape_count):
        pairs.shape_pair_end[world, shape] = 0
    for i in range(count):
        shape = pairs.listed_found[world, i][side]
        pairs.shape_pair_end[world, shape] = pairs.shape_pair_end[world, shape] + 1
    total = Int32(0)
    most = Int32(0)
    for shape in range(settings.shape_count):
        size = pairs.shape_pair_end[world, shape]
        most = wp.max(most, size)
        pairs.shape_pair_end[world, shape] = total
        total += size
    for i in range(count):
        pair = pairs.listed_found[world, i]
        place = pairs.shape_pair_end[world, pair[side]]
        pairs.shape_pair_end[world, pair[side]] = place + 1
        pairs.listed_shapes[world, place] = pair
    return most


@func
def sort_list(settings: Settings, pairs: Pairs, world: Int32):
    """Sort the list by first, then by second shape: the order must not depend on the traversal."""
    if distribute(settings, pairs, world, Int32(0)) > MANY_OF_ONE:
        # A floor, terrain or compound meets most shapes. Rows with the same first shape keep their order.
        distribute(settings, pairs, world, Int32(1))
        for i in range(pairs.count_pairs[world, LISTED]):
            pairs.listed_found[world, i] = pairs.listed_shapes[world, i]
        distribute(settings, pairs, world, Int32(0))
        return
    # Insertion sort by second shape, as few pairs share a first shape. It cannot be part of what distributes
    # them: until that ends, some rows of `listed_shapes` are left over from an earlier list.
    count = pairs.count_pairs[world, LISTED]
    for i in range(1, count):
        pair = pairs.listed_shapes[world, i]
        place = i + 0
        searching = place > 0
        while searching:
            before = pairs.listed_shapes[world, place - 1]
            searching = before[0] == pair[0] and before[1] > pair[1]
            if searching:
                pairs.listed_shapes[world, place] = before
                place -= 1
                searching = place > 0
        pairs.listed_shapes[world, place] = pair
