"""Broad phase: the pairs of shapes whose bounding boxes (AABBs) meet, sorted by shape rows.

Boxes meet if the gap between them is at most a margin (`bounds_margin`). Other pairs are near each other, and
selected as well: they matter for the order of the others (`overlaps.py`). Both are selected from a list that
lasts for several substeps (`neighbour_list.py`).
"""

import warp as wp

from carom.kernels.contact.bounds import gap_between, is_bounded, look_ahead, own_bounds, place_shapes
from carom.kernels.contact.contact_margins import is_part_of_compound, margin_of_gap
from carom.kernels.contact.neighbour_list import renew_list
from carom.kernels.contact.overlaps import overlap_from, present_breaking
from carom.kernels.structs import Contacts, Model, Pairs, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, func, real
from carom.layouts.codes import OTHER_PART
from carom.layouts.contacts import (
    CLOSE,
    CLOSE_WITH_MANIFOLD,
    FAR,
    KNOWN,
    LIST_FILTER,
    LISTED,
    MEETING,
    NO_LIST,
    PAIRS,
    READINESS,
    STALE,
)


@func
def nearness_to_plane(
    shapes: Shapes,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    plane: Int32,
    b: Int32,
    breaking: real,
    known: Int32,
) -> Int32:
    """The nearness of a plane and a shape: they meet if the shape reaches below it or into its margin.

    `breaking` is the breaking distance of their manifold [m]. The bounds of a new shape overlap those of the
    plane in any case; new are all but the first `known` ones.
    """
    normal = pairs.shape_frame[world, plane] * shapes.shape_size[world, plane]
    along = wp.abs(normal)
    height = wp.dot(normal, pairs.shape_position[world, plane])
    lower, upper = own_bounds(shapes, pairs, world, b)
    nearest = 0.5 * (wp.dot(normal, lower + upper) - wp.dot(along, upper - lower)) - height
    if nearest <= margin_of_gap(shapes, settings, pairs, world, plane, b, breaking, nearest):
        return Int32(MEETING)
    return wp.where(wp.max(plane, b) >= known, Int32(CLOSE_WITH_MANIFOLD), Int32(FAR))


@func
def nearness_of(
    shapes: Shapes, settings: Settings, pairs: Pairs, world: Int32, a: Int32, b: Int32, breaking: real
) -> Int32:
    """The nearness of two bounded shapes; `breaking` is the breaking distance of their manifold [m].

    Bullet compares the bounds of links. Of a compound, only parts whose own bounds meet the other shape have
    a manifold; the first part stands for the link as well.
    """
    gap = gap_between(
        pairs.shape_lower[world, a],
        pairs.shape_upper[world, a],
        pairs.shape_lower[world, b],
        pairs.shape_upper[world, b],
    )
    margin = margin_of_gap(shapes, settings, pairs, world, a, b, breaking, gap)
    if is_part_of_compound(shapes, a) or is_part_of_compound(shapes, b):
        return nearness_of_parts(shapes, settings, pairs, world, a, b, gap, margin)
    if gap <= margin:
        return Int32(MEETING)
    return wp.where(gap > settings.near, Int32(FAR), Int32(CLOSE_WITH_MANIFOLD))


@func
def nearness_of_parts(
    shapes: Shapes,
    settings: Settings,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    gap: real,
    margin: real,
) -> Int32:
    """The nearness of two shapes of which one is a part of a compound.

    Args:
        shapes: All shapes.
        settings: Has the gap up to which bounds overlap.
        pairs: Their bounds.
        world: The world.
        a: A shape.
        b: The other one.
        gap: Gap between their bounds, which are those of the link for the first part of a compound [m].
        margin: Largest gap between their own bounds at which they meet [m].
    """
    if gap <= margin:
        lower_a, upper_a = own_bounds(shapes, pairs, world, a)
        lower_b, upper_b = own_bounds(shapes, pairs, world, b)
        if gap_between(lower_a, upper_a, lower_b, upper_b) <= margin:
            return Int32(MEETING)
    stand_for_links = shapes.shape_part[a] != OTHER_PART and shapes.shape_part[b] != OTHER_PART
    return wp.where(stand_for_links and gap <= settings.near, Int32(CLOSE), Int32(FAR))


@func
def select_pairs(shapes: Shapes, settings: Settings, contacts: Contacts, pairs: Pairs, world: Int32):
    """Select the listed pairs that are near now; pairs beyond the capacity are only counted."""
    row = Int32(0)
    known = contacts.count_contacts[world, KNOWN]
    count = Int32(0)
    for i in range(pairs.count_pairs[world, LISTED]):
        pair = pairs.listed_shapes[world, i]
        row = overlap_from(contacts, world, row, pair)
        breaking = present_breaking(shapes, contacts, world, row, pair)
        nearness = Int32(FAR)
        if not is_bounded(shapes, pair[0]):
            nearness = nearness_to_plane(shapes, settings, pairs, world, pair[0], pair[1], breaking, known)
        elif not is_bounded(shapes, pair[1]):
            nearness = nearness_to_plane(shapes, settings, pairs, world, pair[1], pair[0], breaking, known)
        else:
            nearness = nearness_of(shapes, settings, pairs, world, pair[0], pair[1], breaking)
        if nearness != FAR:
            if count < pairs.pair_shapes.shape[1]:
                pairs.pair_shapes[world, count] = pair
                pairs.pair_nearness[world, count] = nearness
                pairs.pair_breaking[world, count] = breaking
            count += 1
    pairs.count_pairs[world, PAIRS] = count


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
    """Find the pairs of shapes whose bounds meet and that may collide, from the link poses."""
    for shape in range(settings.shape_count):
        pairs.shape_motion[world, shape] = look_ahead(shapes, model, settings, state, scratch, world, shape)
    place_shapes(shapes, state, settings, pairs, world)
    find_pairs_of_placed(shapes, model, settings, contacts, pairs, world)


@func
def find_pairs_of_placed(
    shapes: Shapes, model: Model, settings: Settings, contacts: Contacts, pairs: Pairs, world: Int32
):
    """Do what `find_pairs` does, with the poses and bounds of all shapes already written."""
    pairs.count_pairs[world, READINESS] = STALE
    renew_list(shapes, model, settings, pairs, world)
    if pairs.count_pairs[world, LIST_FILTER] == NO_LIST:
        # The list does not fit, so neither may the pairs.
        pairs.count_pairs[world, PAIRS] = pairs.count_pairs[world, LISTED]
        return
    select_pairs(shapes, settings, contacts, pairs, world)
