"""The order in which Bullet finds the overlaps of one body in a scene that is stepped for the first time.

Bullet's broad phase is a binary tree of bounds. A new leaf is inserted beside the leaf at which a descent
from the root ends that takes the nearer child each time, by the distance of centres along the three axes; it
is the second child of a new node. Bodies are inserted when they are created; in a step each is taken out, and
inserted again with its widened bounds. Then a traversal, second children first, finds what it overlaps.

So the order depends on everything that has been in the tree. In a new scene it follows from the present
bounds, and from those with which bodies are created; later it does not, and `overlaps` has a simple rule in its place.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet
from carom.kernels.contact.resets import is_moved
from carom.kernels.maths.min_max import lower_corner, upper_corner
from carom.kernels.structs import Pairs, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, func, real
from carom.layouts.codes import OTHER_PART

_NONE = wp.constant(-1)
# When bounds are brought up to date: when a body is created; when it is reset; in the step.
STAGES = wp.constant(3)


@func
def distance(pairs: Pairs, world: Int32, node: Int32, other: Int32) -> real:
    """Twice the distance between the centres of two nodes, summed over the axes."""
    apart = wp.abs(
        (pairs.twig_lower[world, node] + pairs.twig_upper[world, node])
        - (pairs.twig_lower[world, other] + pairs.twig_upper[world, other])
    )
    return apart[0] + apart[1] + apart[2]


@func
def set_parent(pairs: Pairs, world: Int32, node: Int32, parent: Int32):
    """Set the parent of a node."""
    links = pairs.twig_links[world, node]
    pairs.twig_links[world, node] = Index4(parent, links[1], links[2], 0)


@func
def set_child(pairs: Pairs, world: Int32, parent: Int32, child: Int32, other: Int32):
    """Put another node in the place of a child."""
    links = pairs.twig_links[world, parent]
    if links[1] == child:
        pairs.twig_links[world, parent] = Index4(links[0], other, links[2], 0)
    else:
        pairs.twig_links[world, parent] = Index4(links[0], links[1], other, 0)
    set_parent(pairs, world, other, parent)


@func
def enclose(pairs: Pairs, world: Int32, node: Int32) -> bool:
    """Set the bounds of a node to those around its children; returns whether they have changed."""
    links = pairs.twig_links[world, node]
    lower = lower_corner(pairs.twig_lower[world, links[1]], pairs.twig_lower[world, links[2]])
    upper = upper_corner(pairs.twig_upper[world, links[1]], pairs.twig_upper[world, links[2]])
    same = lower == pairs.twig_lower[world, node] and upper == pairs.twig_upper[world, node]
    pairs.twig_lower[world, node] = lower
    pairs.twig_upper[world, node] = upper
    return not same


@func
def enclose_from(pairs: Pairs, world: Int32, node: Int32):
    """Bring the bounds of a node and of those above it up to date."""
    above = node + 0
    while above >= 0:
        changed = enclose(pairs, world, above)
        above = wp.where(changed, pairs.twig_links[world, above][0], Int32(_NONE))


@func
def insert_leaf(pairs: Pairs, world: Int32, root: Int32, leaf: Int32, node: Int32) -> Int32:
    """Insert a leaf, with `node` as the new node above it; returns the root."""
    pairs.twig_links[world, leaf] = Index4(_NONE, _NONE, _NONE, 0)
    if root < 0:
        return leaf
    beside = root + 0
    while pairs.twig_links[world, beside][1] >= 0:
        links = pairs.twig_links[world, beside]
        if distance(pairs, world, leaf, links[1]) < distance(pairs, world, leaf, links[2]):
            beside = links[1]
        else:
            beside = links[2]
    parent = pairs.twig_links[world, beside][0]
    pairs.twig_links[world, node] = Index4(_NONE, beside, leaf, 0)
    if parent >= 0:
        set_child(pairs, world, parent, beside, node)
    set_parent(pairs, world, beside, node)
    set_parent(pairs, world, leaf, node)
    enclose(pairs, world, node)
    enclose_from(pairs, world, parent)
    return wp.where(parent >= 0, root, node)


@func
def remove_leaf(pairs: Pairs, world: Int32, root: Int32, leaf: Int32):
    """Take out a leaf; returns the root, and the node that was above the leaf; -1 where there is none."""
    parent = pairs.twig_links[world, leaf][0]
    if parent < 0:
        return Int32(_NONE), Int32(_NONE)
    links = pairs.twig_links[world, parent]
    sibling = wp.where(links[1] == leaf, links[2], links[1])
    if links[0] < 0:
        set_parent(pairs, world, sibling, _NONE)
        return sibling, parent
    set_child(pairs, world, links[0], parent, sibling)
    enclose_from(pairs, world, links[0])
    return root, parent


@func
def put_forward(pairs: Pairs, world: Int32, first: Int32, end: Int32, shape: Int32) -> Int32:
    """Swap the new overlap with a shape to the beginning of [first, end) in `queue_turn`.

    Returns:
        The beginning of the rest; `first` if there is no such overlap.
    """
    for place in range(first, end):
        row = pairs.queue_turn[world, place]
        pair = pairs.queue_new[world, row].pair
        if pair[0] == shape or pair[1] == shape:
            pairs.queue_turn[world, place] = pairs.queue_turn[world, first]
            pairs.queue_turn[world, first] = row
            return first + 1
    return first


@func
def sort_found(pairs: Pairs, world: Int32, root: Int32, leaf: Int32, first: Int32, end: Int32):
    """Sort the new overlaps of one leaf, [first, end) in `queue_turn`, in the order of the traversal."""
    place = first + 0
    waiting = Int32(1)
    pairs.twig_stack[world, 0] = root
    while waiting > 0:
        waiting -= 1
        node = pairs.twig_stack[world, waiting]
        if node != leaf and boxes_meet(
            pairs.twig_lower[world, node],
            pairs.twig_upper[world, node],
            pairs.twig_lower[world, leaf],
            pairs.twig_upper[world, leaf],
            real(0.0),
        ):
            links = pairs.twig_links[world, node]
            if links[1] >= 0:
                pairs.twig_stack[world, waiting] = links[1]
                pairs.twig_stack[world, waiting + 1] = links[2]
                waiting += 2
            else:
                place = put_forward(pairs, world, place, end, node)


@func
def end_of_turn(pairs: Pairs, world: Int32, first: Int32, count: Int32, turn: Int32) -> Int32:
    """End of the new overlaps of one turn, which begin at `first` in `queue_turn`."""
    end = first + 0
    searching = end < count
    while searching:
        searching = pairs.queue_new[world, pairs.queue_turn[world, end]].turn == turn
        if searching:
            end += 1
            searching = end < count
    return end


@func
def shape_of_turn(settings: Settings, pairs: Pairs, world: Int32, turn: Int32, resets: Int32) -> Int32:
    """The shape whose bounds are brought up to date in a turn; -1 for none."""
    place = turn % settings.shape_count
    stage = turn // settings.shape_count
    if stage == 1:
        return wp.where(place < resets, pairs.shape_reset[world, place], Int32(_NONE))
    if stage == 2 and resets > 0 and pairs.shape_reset_place[world, place] >= 0:
        # Bounds that have not changed since the reset.
        return _NONE
    return place


@func
def sort_as_in_new_scene(
    settings: Settings,
    shapes: Shapes,
    state: State,
    pairs: Pairs,
    world: Int32,
    count: Int32,
    resets: Int32,
    widening: real,
):
    """Sort new overlaps of the same turn, of which there are `count` in all, by building Bullet's tree.

    Where bodies were that a reset has moved is not known: they are inserted where it has put them.

    Args:
        settings: Number of shapes.
        shapes: Which of them stand for their links: these are the leaves.
        state: Which trees have been moved.
        pairs: Bounds of the shapes, in `twig_lower` and `twig_upper` those with which they are created; those
            that have been reset; `queue_turn` has the new overlaps sorted by
            turn, see `overlap_turns.turn_of`.
        world: The world.
        count: Number of new overlaps.
        resets: Number of shapes that have been reset.
        widening: How far bounds are widened in a step [m].
    """
    wide = Vector3(widening, widening, widening)
    root = Int32(_NONE)
    first = Int32(0)
    for turn in range(STAGES * settings.shape_count):
        shape = shape_of_turn(settings, pairs, world, turn, resets)
        if shape < 0:
            continue
        end = end_of_turn(pairs, world, first, count, turn)
        is_creation = turn < settings.shape_count
        comes_later = is_moved(shapes, state, pairs, world, shape, resets)
        lower = pairs.shape_lower[world, shape]
        upper = pairs.shape_upper[world, shape]
        if (
            lower[0] <= upper[0]
            and shapes.shape_part[shape] != OTHER_PART
            and not (is_creation and comes_later)
        ):
            node = settings.shape_count + shape
            if not is_creation:
                if not comes_later:
                    root, node = remove_leaf(pairs, world, root, shape)
                pairs.twig_lower[world, shape] = lower - wide
                pairs.twig_upper[world, shape] = upper + wide
            root = insert_leaf(pairs, world, root, shape, node)
            if end - first > 1:
                sort_found(pairs, world, root, shape, first, end)
        first = end + 0
