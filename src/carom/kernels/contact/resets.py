"""Trees that users have reset since the last substep.

Bullet brings the bounds of a body up to date when its pose, its velocity or a joint is set, link by link,
and looks at once for what they overlap. Bounds that have not changed since are not compared again. So the
overlaps of these bodies come before those that the next step finds, in the order of the calls.
"""

import warp as wp

from carom.kernels.structs import Contacts, Pairs, Settings, Shapes, State
from carom.kernels.types import Int32, func
from carom.layouts.codes import OTHER_PART
from carom.layouts.contacts import MANY_RESETS, RESETS, RESETS_SEEN

_NOT_RESET = wp.constant(-1)


@func
def is_moved(shapes: Shapes, state: State, pairs: Pairs, world: Int32, shape: Int32, resets: Int32) -> bool:
    """Whether a shape was moved by a reset since the last substep; `resets` is from `list_resets`."""
    if resets > 0 and pairs.shape_reset_place[world, shape] >= 0:
        return state.tree_reset[world, shapes.shape_tree[shape]] < 0
    return False


@func
def list_resets(
    settings: Settings, shapes: Shapes, state: State, contacts: Contacts, pairs: Pairs, world: Int32
) -> Int32:
    """List the shapes that stand for links of trees that were reset since the last substep, in this order.

    Returns:
        Their number; if it is 0, `shape_reset_place` is not written.
    """
    seen = contacts.count_contacts[world, RESETS_SEEN]
    if contacts.count_contacts[world, RESETS] == seen:
        return Int32(0)
    count = Int32(0)
    for shape in range(settings.shape_count):
        pairs.shape_reset_place[world, shape] = Int32(_NOT_RESET)
        number = wp.abs(state.tree_reset[world, shapes.shape_tree[shape]])
        if number > seen and shapes.shape_part[shape] != OTHER_PART:
            # Most are in order already.
            place = count + 0
            searching = place > 0
            while searching:
                before = pairs.shape_reset[world, place - 1]
                searching = wp.abs(state.tree_reset[world, shapes.shape_tree[before]]) > number
                if searching:
                    pairs.shape_reset[world, place] = before
                    place -= 1
                    searching = place > 0
            pairs.shape_reset[world, place] = shape
            count += 1
    for place in range(count):
        pairs.shape_reset_place[world, pairs.shape_reset[world, place]] = place
    return count


@func
def forget_resets(settings: Settings, state: State, contacts: Contacts, world: Int32):
    """Note that all overlaps of trees that have been reset are known."""
    count = contacts.count_contacts[world, RESETS]
    if count > MANY_RESETS:
        for tree in range(settings.tree_count):
            state.tree_reset[world, tree] = 0
        count = Int32(0)
        contacts.count_contacts[world, RESETS] = count
    contacts.count_contacts[world, RESETS_SEEN] = count
