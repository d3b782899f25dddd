"""The order in which Bullet finds new overlaps, and lists them in its pair cache; see `overlaps`.

In a scene that is stepped for the first time Bullet's search is repeated. It also finds pairs that are no
overlaps here, because the two are of one body and may not touch each other, or because they met when they
were created, and are apart where the first step has them. After all have been found, the last pair takes the
place of each that is apart: so both matter for the places of the others.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet, made_bounds
from carom.kernels.contact.bounds_tree import insert_leaf, remove_leaf
from carom.kernels.contact.filters import links_may_collide
from carom.kernels.contact.overlap_turns import STAGES, turn_of, widening_of
from carom.kernels.contact.part_order import sort_parts
from carom.kernels.contact.resets import is_moved, list_resets
from carom.kernels.structs import Contacts, Model, Pairs, Settings, Shapes, State
from carom.kernels.types import Index2, Int32, Vector3, func, real
from carom.layouts.codes import OTHER_PART

_NONE = wp.constant(-1)
# Value of `NewOverlap.turn` of parts of compounds, which the search of links does not come across.
_NOT_FOUND = wp.constant(1 << 30)


@func
def put_forward(pairs: Pairs, world: Int32, first: Int32, end: Int32, shape: Int32, number: Int32) -> Int32:
    """Swap the new overlap with a shape to the beginning of [first, end) in `queue_turn`, and number it.

    Returns:
        The beginning of the rest; `first` if there is no such overlap.
    """
    for place in range(first, end):
        row = pairs.queue_turn[world, place]
        pair = pairs.queue_new[world, row].pair
        if pair[0] == shape or pair[1] == shape:
            pairs.queue_turn[world, place] = pairs.queue_turn[world, first]
            pairs.queue_turn[world, first] = row
            pairs.queue_new[world, row].turn = number
            return first + 1
    return first


@func
def is_listed(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    pair: Index2,
    turn: Int32,
    resets: Int32,
) -> bool:
    """Whether Bullet lists two shapes that are no new overlap, and finds them in a turn; `pair` is sorted."""
    a, b = shapes.shape_link[pair[0]], shapes.shape_link[pair[1]]
    if not links_may_collide(shapes, settings, a, b):
        return False
    return turn_of(settings, shapes, model, state, pairs, world, pair, 0, resets) == turn


@func
def search(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    root: Int32,
    leaf: Int32,
    first: Int32,
    end: Int32,
    turn: Int32,
    resets: Int32,
    number: Int32,
    apart: Int32,
):
    """Number all that Bullet finds for one leaf in a turn.

    Args:
        settings: Time step, number of shapes.
        shapes: All shapes.
        model: The trees.
        state: Their velocities.
        pairs: The new overlaps of this turn are sorted in the order of the search; `queue_entry` gets the
            numbers of pairs that are apart.
        world: The world.
        root: Root of the tree.
        leaf: The leaf.
        first: Where its new overlaps begin in `queue_turn`.
        end: Where they end.
        turn: The turn.
        resets: Number of shapes that have been reset.
        number: How many pairs have been found before.
        apart: How many of them are apart.

    Returns:
        Both numbers, after the search.
    """
    place = first + 0
    count = number + 0
    ended = apart + 0
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
                after = put_forward(pairs, world, place, end, node, count)
                pair = Index2(wp.min(node, leaf), wp.max(node, leaf))
                if after > place:
                    place = after
                    count += 1
                elif is_listed(settings, shapes, model, state, pairs, world, pair, turn, resets):
                    if are_apart(settings, pairs, world, pair):
                        if ended < pairs.queue_entry.shape[1]:
                            pairs.queue_entry[world, ended] = count
                        ended += 1
                    count += 1
    return number_rest(shapes, pairs, world, place, end, count), ended


@func
def number_rest(shapes: Shapes, pairs: Pairs, world: Int32, first: Int32, end: Int32, number: Int32) -> Int32:
    """Number new overlaps, [first, end) in `queue_turn`, that no search finds; returns the next number.

    They are of parts of compounds, or with planes that a body met before it was reset.
    """
    count = number + 0
    for place in range(first, end):
        row = pairs.queue_turn[world, place]
        pair = pairs.queue_new[world, row].pair
        if shapes.shape_part[pair[0]] != OTHER_PART and shapes.shape_part[pair[1]] != OTHER_PART:
            pairs.queue_new[world, row].turn = count
            count += 1
        else:
            pairs.queue_new[world, row].turn = _NOT_FOUND
    return count


@func
def are_apart(settings: Settings, pairs: Pairs, world: Int32, pair: Index2) -> bool:
    """Whether the present bounds of two shapes do not meet, widened as Bullet's are in a step."""
    return not boxes_meet(
        pairs.shape_lower[world, pair[0]],
        pairs.shape_upper[world, pair[0]],
        pairs.shape_lower[world, pair[1]],
        pairs.shape_upper[world, pair[1]],
        settings.near,
    )


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
def search_new_scene(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    count: Int32,
    resets: Int32,
    widening: real,
):
    """Sort new overlaps, of which there are `count` in all, by building Bullet's tree and searching it.

    Where bodies were that a reset has moved is not known: they are inserted where it has put them.

    Args:
        settings: Number of shapes.
        shapes: Which of them stand for their links: these are the leaves.
        model: The trees.
        state: Which of them have been moved.
        pairs: Bounds of the shapes, those that have been reset; `queue_turn` has the new overlaps sorted by
            turn, see `overlap_turns.turn_of`. `queue_entry` gets the numbers of pairs that are apart.
        world: The world.
        count: Number of new overlaps.
        resets: Number of shapes that have been reset.
        widening: How far bounds are widened in a step [m].

    Returns:
        Number of all pairs found, and of those that are apart.
    """
    wide = Vector3(widening, widening, widening)
    root = Int32(_NONE)
    first = Int32(0)
    number = Int32(0)
    apart = Int32(0)
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
            if is_creation:
                lower, upper = made_bounds(shapes, model, state, pairs, world, shape)
            else:
                if not comes_later:
                    root, node = remove_leaf(pairs, world, root, shape)
                lower = lower - wide
                upper = upper + wide
            pairs.twig_lower[world, shape] = lower
            pairs.twig_upper[world, shape] = upper
            root = insert_leaf(pairs, world, root, shape, node)
            number, apart = search(
                settings,
                shapes,
                model,
                state,
                pairs,
                world,
                root,
                shape,
                first,
                end,
                turn,
                resets,
                number,
                apart,
            )
        else:
            number = number_rest(shapes, pairs, world, first, end, number)
        first = end + 0
    return number, apart


@func
def fill_gaps(pairs: Pairs, world: Int32, count: Int32, number: Int32, apart: Int32):
    """Let the last pairs take the places of those that are apart.

    Args:
        pairs: `queue_turn` has the new overlaps as they were found, with their numbers; `queue_entry` the
            numbers of pairs that are apart, and is overwritten.
        world: The world.
        count: Number of new overlaps.
        number: Number of pairs that were found.
        apart: Number of those that are apart, at least one.
    """
    left = number - apart
    # What is found after `left` pairs goes into the gaps before, the last pair into the first gap.
    gap = Int32(0)
    ended = apart - 1
    place = count - 1
    last = number - 1
    while last >= left:
        if ended >= 0 and pairs.queue_entry[world, ended] == last:
            ended -= 1
        else:
            while place >= 0 and pairs.queue_new[world, pairs.queue_turn[world, place]].turn > last:
                place -= 1
            if place >= 0:
                row = pairs.queue_turn[world, place]
                if pairs.queue_new[world, row].turn == last:
                    pairs.queue_new[world, row].turn = pairs.queue_entry[world, gap]
                    place -= 1
            gap += 1
        last -= 1
    sort_by_number(pairs, world, count)


@func
def sort_by_number(pairs: Pairs, world: Int32, count: Int32):
    """Sort `queue_turn` by the numbers of the new overlaps; those that are equal keep their order."""
    for i in range(1, count):
        row = pairs.queue_turn[world, i]
        number = pairs.queue_new[world, row].turn
        place = i + 0
        searching = place > 0
        while searching:
            before = pairs.queue_turn[world, place - 1]
            searching = pairs.queue_new[world, before].turn > number
            if searching:
                pairs.queue_turn[world, place] = before
                place -= 1
                searching = place > 0
        pairs.queue_turn[world, place] = row


@func
def sort_new(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    known: Int32,
    count: Int32,
) -> Int32:
    """List new overlaps in the order in which Bullet finds them.

    One body's overlaps are found in the order of a tree of bounds, which depends on all motion so far. It is
    known only in a new scene; else those with later bodies come first. Parts of compounds follow each other.

    Returns:
        0, or the number of overlaps that there must be room for.
    """
    resets = Int32(0)
    if count > 0:
        resets = list_resets(settings, shapes, state, contacts, pairs, world)
    for i in range(count):
        pair = pairs.queue_new[world, i].pair
        turn = turn_of(settings, shapes, model, state, pairs, world, pair, known, resets)
        pairs.queue_new[world, i].turn = turn
    first = Int32(0)
    for stage in range(STAGES):
        lowest = stage * settings.shape_count
        for shape in range(settings.shape_count):
            pairs.shape_pair_end[world, shape] = 0
        for i in range(count):
            turn = pairs.queue_new[world, i].turn - lowest
            if turn >= 0 and turn < settings.shape_count:
                pairs.shape_pair_end[world, turn] = pairs.shape_pair_end[world, turn] + 1
        for shape in range(settings.shape_count):
            size = pairs.shape_pair_end[world, shape]
            pairs.shape_pair_end[world, shape] = first
            first += size
        i = count + 0
        while i > 0:
            i -= 1
            turn = pairs.queue_new[world, i].turn - lowest
            if turn >= 0 and turn < settings.shape_count:
                place = pairs.shape_pair_end[world, turn]
                pairs.queue_turn[world, place] = i
                pairs.shape_pair_end[world, turn] = place + 1
    if known == 0 and count > 0:
        number, apart = search_new_scene(
            settings, shapes, model, state, pairs, world, count, resets, widening_of(settings)
        )
        if apart > pairs.queue_entry.shape[1]:
            return apart
        if apart > 0:
            fill_gaps(pairs, world, count, number, apart)
    if count > 1:
        sort_parts(shapes, pairs, world, count)
    return Int32(0)
