"""The order in which Bullet comes across the parts of compounds.

The parts of a link are in a tree of bounds; `model.placed_pieces` has where. It is searched second children
first. Of two compounds the nodes of both trees are divided at once, and those of the second come first.
"""

from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Index2, Int32, func
from carom.layouts.codes import ALONE

_DONE = -1
"""Value of `NewOverlap.turn` of those that are in their place."""


@func
def differs_later(a: Int32, b: Int32) -> bool:
    """Whether the highest bit of one number, which is not negative, is lower than that of another one."""
    return a < b and a < (a ^ b)


@func
def is_found_first(shapes: Shapes, world: Int32, pair: Index2, other: Index2) -> bool:
    """Whether a pair of shapes comes before another one of the same two links."""
    path_a, other_a = shapes.shape_path[world, pair[0]], shapes.shape_path[world, other[0]]
    path_b, other_b = shapes.shape_path[world, pair[1]], shapes.shape_path[world, other[1]]
    if path_b == other_b or differs_later(path_b ^ other_b, path_a ^ other_a):
        return path_a > other_a
    return path_b > other_b


@func
def new_overlap_of(pairs: Pairs, world: Int32, count: Int32, a: Int32, b: Int32) -> Int32:
    """Row of the new overlap, of `count`, of two shapes; -1 if there is none."""
    first = Int32(0)
    end = count + 0
    while first < end:
        middle = (first + end) // 2
        pair = pairs.queue_new[world, middle].pair
        if pair[0] == a and pair[1] == b:
            return middle
        if pair[0] < a or (pair[0] == a and pair[1] < b):
            first = middle + 1
        else:
            end = middle + 0
    return Int32(-1)


@func
def insert_part(shapes: Shapes, pairs: Pairs, world: Int32, first: Int32, end: Int32, row: Int32):
    """Insert a new overlap into those of its links, [first, end) in `queue_entry`."""
    pair = pairs.queue_new[world, row].pair
    place = end + 0
    searching = place > first
    while searching:
        before = pairs.queue_entry[world, place - 1]
        searching = is_found_first(shapes, world, pair, pairs.queue_new[world, before].pair)
        if searching:
            pairs.queue_entry[world, place] = before
            place -= 1
            searching = place > first
    pairs.queue_entry[world, place] = row
    pairs.queue_new[world, row].turn = _DONE


@func
def sort_parts(shapes: Shapes, pairs: Pairs, world: Int32, count: Int32):
    """Put new overlaps of the same two links, of which one is a compound, together and in their order.

    Args:
        shapes: All shapes.
        pairs: `queue_turn` has the new overlaps in the order in which Bullet finds their links; `queue_entry`
            is overwritten.
        world: The world.
        count: Number of new overlaps.
    """
    end = Int32(0)
    for place in range(count):
        row = pairs.queue_turn[world, place]
        pair = pairs.queue_new[world, row].pair
        if shapes.shape_part[pair[0]] == ALONE and shapes.shape_part[pair[1]] == ALONE:
            pairs.queue_entry[world, end] = row
            end += 1
        elif pairs.queue_new[world, row].turn != _DONE:
            first = end + 0
            link_a, link_b = shapes.shape_link[pair[0]], shapes.shape_link[pair[1]]
            first_a, first_b = shapes.link_first_shape[link_a], shapes.link_first_shape[link_b]
            for a in range(first_a, first_a + shapes.link_shape_count[link_a]):
                for b in range(first_b, first_b + shapes.link_shape_count[link_b]):
                    found = new_overlap_of(pairs, world, count, a, b)
                    if found >= 0:
                        insert_part(shapes, pairs, world, first, end, found)
                        end += 1
    for place in range(count):
        pairs.queue_turn[world, place] = pairs.queue_entry[world, place]
