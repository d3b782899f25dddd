"""Overlaps: pairs of shapes whose bounds meet, in the two orders in which Bullet has them.

Bullet keeps a *pair cache*: the pairs of bodies whose widened bounds overlap. Pairs are appended as they are
found, body by body; a pair whose bounds have parted is replaced by the last one. Each pair has a manifold,
also if the two do not touch; with parts of compounds only where bounds that are not widened overlap.
Manifolds are in an array with the same two rules, but a pair found in this substep gets its manifold only
after others have lost theirs. So the two orders differ. The solver relaxes manifolds in the second
(`solver.contact_order`).

Overlaps are stored sorted by shapes, like pairs and contacts, with both places. Most substeps change nothing;
then this takes one comparison of each overlap.
"""

import warp as wp

from carom.kernels.contact.bounds import is_bounded
from carom.kernels.contact.contact_margins import breaking_distance, processing_threshold
from carom.kernels.contact.resets import forget_resets
from carom.kernels.contact.search_order import sort_new
from carom.kernels.structs import Contacts, Model, NewOverlap, Overlap, Pairs, Settings, Shapes, State
from carom.kernels.types import Index2, Int32, called_func, func, real
from carom.layouts.contacts import (
    CLOSE,
    KNOWN,
    NO_MANIFOLD,
    NONE_KEPT,
    OVERLAPS,
    PAIRS,
    RESETS_SEEN,
    SORTED,
    START_KNOWN,
    START_OVERLAPS,
    START_RESETS_SEEN,
)

# Value of `Pairs.queue_wanted` for overlaps that have ended; else 1 if there is to be a manifold, 0 if not.
GONE = wp.constant(-1)


@func
def is_before(a: Int32, b: Int32, other_a: Int32, other_b: Int32) -> bool:
    """Whether a pair of shapes comes before another."""
    return a < other_a or (a == other_a and b < other_b)


@func
def is_unbounded(shapes: Shapes, pair: Index2) -> bool:
    """Whether one of two shapes is an infinite plane, whose bounds meet those of all others."""
    return not (is_bounded(shapes, pair[0]) and is_bounded(shapes, pair[1]))


@func
def has_manifold(nearness: Int32) -> Int32:
    """1 if Bullet has a manifold for two shapes that are so near, else 0."""
    return wp.where(nearness == CLOSE, Int32(0), Int32(1))


@func
def read_overlap(contacts: Contacts, world: Int32, row: Int32) -> Overlap:
    """An overlap with its places in both orders."""
    overlap = Overlap()
    overlap.pair = contacts.overlap_shapes[world, row]
    overlap.place = contacts.overlap_place[world, row]
    overlap.manifold = contacts.overlap_manifold[world, row]
    overlap.breaking = contacts.overlap_breaking[world, row]
    overlap.solved_up_to = contacts.overlap_solved_up_to[world, row]
    return overlap


@func
def write_overlap(contacts: Contacts, world: Int32, row: Int32, overlap: Overlap):
    """Write a row of the overlaps."""
    contacts.overlap_shapes[world, row] = overlap.pair
    contacts.overlap_place[world, row] = overlap.place
    contacts.overlap_manifold[world, row] = overlap.manifold
    contacts.overlap_breaking[world, row] = overlap.breaking
    contacts.overlap_solved_up_to[world, row] = overlap.solved_up_to


@func
def made_new(pair: Index2, wanted: Int32) -> NewOverlap:
    """A new overlap, which has no places yet."""
    new = NewOverlap()
    new.pair = pair
    new.wanted = wanted
    new.manifold = Int32(NO_MANIFOLD)
    return new


@func
def as_overlap(pairs: Pairs, world: Int32, row: Int32) -> Overlap:
    """A new overlap as a row of the overlaps."""
    new = pairs.queue_new[world, row]
    overlap = Overlap()
    overlap.pair = new.pair
    overlap.place = new.place
    overlap.manifold = new.manifold
    overlap.breaking = new.breaking
    overlap.solved_up_to = new.solved_up_to
    return overlap


@func
def overlap_from(contacts: Contacts, world: Int32, first: Int32, pair: Index2) -> Int32:
    """The first overlap from row `first` on that does not come before a pair of shapes."""
    row = first + 0
    searching = row < contacts.count_contacts[world, OVERLAPS]
    while searching:
        shapes = contacts.overlap_shapes[world, row]
        searching = is_before(shapes[0], shapes[1], pair[0], pair[1])
        if searching:
            row += 1
            searching = row < contacts.count_contacts[world, OVERLAPS]
    return row


@func
def present_breaking(shapes: Shapes, contacts: Contacts, world: Int32, row: Int32, pair: Index2) -> real:
    """Breaking distance of the manifold of a pair, which is overlap `row` or none [m]."""
    if row < contacts.count_contacts[world, OVERLAPS]:
        old = contacts.overlap_shapes[world, row]
        breaking = contacts.overlap_breaking[world, row]
        has_one = contacts.overlap_manifold[world, row] != NO_MANIFOLD and breaking >= 0.0
        if has_one and old[0] == pair[0] and old[1] == pair[1]:
            return breaking
    return breaking_distance(shapes, world, pair[0], pair[1])


@func
def make_manifold(shapes: Shapes, contacts: Contacts, pairs: Pairs, world: Int32, entry: Int32, place: Int32):
    """Let an entry of `queue_entry` have a manifold from now on, at a place among manifolds."""
    pairs.queue_manifold[world, place] = entry
    set_manifold(contacts, pairs, world, entry, place)
    if entry >= 0:
        pair = contacts.overlap_shapes[world, entry]
        contacts.overlap_breaking[world, entry] = breaking_distance(shapes, world, pair[0], pair[1])
        contacts.overlap_solved_up_to[world, entry] = processing_threshold(shapes, world, pair)
    else:
        pair = pairs.queue_new[world, -1 - entry].pair
        pairs.queue_new[world, -1 - entry].breaking = breaking_distance(shapes, world, pair[0], pair[1])
        pairs.queue_new[world, -1 - entry].solved_up_to = processing_threshold(shapes, world, pair)


@func
def are_same(shapes: Shapes, contacts: Contacts, pairs: Pairs, world: Int32) -> bool:
    """Whether the present pairs are the overlaps of the last substep, with the same manifolds."""
    count = pairs.count_pairs[world, PAIRS]
    i = Int32(0)
    for row in range(contacts.count_contacts[world, OVERLAPS]):
        old = contacts.overlap_shapes[world, row]
        matches = False
        if i < count:
            pair = pairs.pair_shapes[world, i]
            matches = pair[0] == old[0] and pair[1] == old[1]
            if matches:
                has = contacts.overlap_manifold[world, row] != NO_MANIFOLD
                if has == (pairs.pair_nearness[world, i] == CLOSE):
                    return False
        if matches:
            i += 1
        elif not is_unbounded(shapes, old):
            return False
    return i == count


@func
def find_changes(shapes: Shapes, contacts: Contacts, pairs: Pairs, world: Int32):
    """Note what becomes of each overlap, and list new ones; returns the numbers of ended and new ones."""
    count = pairs.count_pairs[world, PAIRS]
    old_count = contacts.count_contacts[world, OVERLAPS]
    gone = Int32(0)
    fresh = Int32(0)
    row = Int32(0)
    for i in range(count):
        pair = pairs.pair_shapes[world, i]
        searching = row < old_count
        while searching:
            old = contacts.overlap_shapes[world, row]
            searching = is_before(old[0], old[1], pair[0], pair[1])
            if searching:
                gone += note_absent(shapes, pairs, world, row, old)
                row += 1
                searching = row < old_count
        known = False
        if row < old_count:
            old = contacts.overlap_shapes[world, row]
            known = old[0] == pair[0] and old[1] == pair[1]
        if known:
            pairs.queue_wanted[world, row] = has_manifold(pairs.pair_nearness[world, i])
            row += 1
        else:
            wanted = has_manifold(pairs.pair_nearness[world, i])
            pairs.queue_new[world, fresh] = made_new(pair, wanted)
            fresh += 1
    while row < old_count:
        gone += note_absent(shapes, pairs, world, row, contacts.overlap_shapes[world, row])
        row += 1
    return gone, fresh


@func
def note_absent(shapes: Shapes, pairs: Pairs, world: Int32, row: Int32, old: Index2) -> Int32:
    """Note that an overlap is not among the present pairs; returns 1 if it has ended, else 0."""
    if is_unbounded(shapes, old):
        pairs.queue_wanted[world, row] = 1
        return 0
    pairs.queue_wanted[world, row] = GONE
    return 1


@func
def set_manifold(contacts: Contacts, pairs: Pairs, world: Int32, entry: Int32, place: Int32):
    """Set the place among manifolds of an entry of `queue_entry`; NO_MANIFOLD if it has none."""
    if entry >= 0:
        contacts.overlap_manifold[world, entry] = place
    else:
        pairs.queue_new[world, -1 - entry].manifold = place


@func
def drop_manifold(contacts: Contacts, pairs: Pairs, world: Int32, place: Int32, manifolds: Int32) -> Int32:
    """Remove the manifold at a place, which the last one takes; returns the number that remains."""
    last = pairs.queue_manifold[world, manifolds - 1]
    set_manifold(contacts, pairs, world, pairs.queue_manifold[world, place], Int32(NO_MANIFOLD))
    if place < manifolds - 1:
        pairs.queue_manifold[world, place] = last
        set_manifold(contacts, pairs, world, last, place)
    return manifolds - 1


@func
def list_entries(contacts: Contacts, pairs: Pairs, world: Int32, new_count: Int32) -> Int32:
    """List the overlaps in both orders, new ones last in the pair cache; returns the number of manifolds."""
    manifolds = Int32(0)
    old_count = contacts.count_contacts[world, OVERLAPS]
    for row in range(old_count):
        pairs.queue_entry[world, contacts.overlap_place[world, row]] = row
        manifold = contacts.overlap_manifold[world, row]
        if manifold != NO_MANIFOLD:
            pairs.queue_manifold[world, manifold] = row
            manifolds += 1
    for i in range(new_count):
        pairs.queue_entry[world, old_count + i] = -1 - pairs.queue_turn[world, i]
    return manifolds


@func
def remove_ended(contacts: Contacts, pairs: Pairs, world: Int32, count: Int32, manifolds: Int32) -> Int32:
    """Remove the overlaps that have ended from both orders; returns the number of manifolds that remain.

    Args:
        contacts: The overlaps.
        pairs: `queue_entry` and `queue_manifold` have the two orders.
        world: The world.
        count: Number of entries of the pair cache.
        manifolds: Number of manifolds.
    """
    end = count + 0
    left = manifolds + 0
    i = Int32(0)
    while i < end:
        row = pairs.queue_entry[world, i]
        ended = False
        if row >= 0:
            ended = pairs.queue_wanted[world, row] == GONE
        if ended:
            manifold = contacts.overlap_manifold[world, row]
            if manifold != NO_MANIFOLD:
                left = drop_manifold(contacts, pairs, world, manifold, left)
            end -= 1
            pairs.queue_entry[world, i] = pairs.queue_entry[world, end]
        else:
            i += 1
    return left


@func
def visit_pairs(
    shapes: Shapes, contacts: Contacts, pairs: Pairs, world: Int32, count: Int32, manifolds: Int32
):
    """Go through the pair cache: store places in it, make manifolds that are missing, remove others.

    Only parts of compounds have overlaps without manifolds.
    """
    left = manifolds + 0
    for place in range(count):
        entry = pairs.queue_entry[world, place]
        manifold = Int32(NO_MANIFOLD)
        wanted = Int32(0)
        if entry >= 0:
            contacts.overlap_place[world, entry] = place
            manifold = contacts.overlap_manifold[world, entry]
            wanted = pairs.queue_wanted[world, entry]
        else:
            pairs.queue_new[world, -1 - entry].place = place
            wanted = pairs.queue_new[world, -1 - entry].wanted
        if wanted == 0:
            if manifold != NO_MANIFOLD:
                left = drop_manifold(contacts, pairs, world, manifold, left)
        elif manifold == NO_MANIFOLD:
            make_manifold(shapes, contacts, pairs, world, entry, left)
            left += 1


@func
def merge(contacts: Contacts, pairs: Pairs, world: Int32, old_count: Int32, new_count: Int32):
    """Put old overlaps that remain and new ones into one sorted list."""
    count = Int32(0)
    new = Int32(0)
    for row in range(old_count):
        if pairs.queue_wanted[world, row] != GONE:
            old = read_overlap(contacts, world, row)
            inserting = new < new_count
            while inserting:
                added = pairs.queue_new[world, new].pair
                inserting = is_before(added[0], added[1], old.pair[0], old.pair[1])
                if inserting:
                    pairs.queue_merged[world, count] = as_overlap(pairs, world, new)
                    count += 1
                    new += 1
                    inserting = new < new_count
            pairs.queue_merged[world, count] = old
            count += 1
    while new < new_count:
        pairs.queue_merged[world, count] = as_overlap(pairs, world, new)
        count += 1
        new += 1
    for row in range(count):
        write_overlap(contacts, world, row, pairs.queue_merged[world, row])
    contacts.count_contacts[world, OVERLAPS] = count


@called_func
def update_overlaps(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
) -> Int32:
    """Update the overlaps of the last substep to the present pairs.

    Returns:
        0, or the number of overlaps if they do not fit; then they are left as they were.
    """
    known = contacts.count_contacts[world, KNOWN]
    if known == settings.shape_count and are_same(shapes, contacts, pairs, world):
        forget_resets(settings, state, contacts, world)
        return 0
    gone, fresh = find_changes(shapes, contacts, pairs, world)
    old_count = contacts.count_contacts[world, OVERLAPS]
    count = old_count - gone + fresh
    if count > contacts.overlap_shapes.shape[1]:
        return count
    keep_overlaps(contacts, pairs, world)
    wanted = sort_new(settings, shapes, model, state, contacts, pairs, world, known, fresh)
    if wanted > 0:
        return wanted
    forget_resets(settings, state, contacts, world)
    manifolds = list_entries(contacts, pairs, world, fresh)
    manifolds = remove_ended(contacts, pairs, world, old_count + fresh, manifolds)
    visit_pairs(shapes, contacts, pairs, world, count, manifolds)
    merge(contacts, pairs, world, old_count, fresh)
    contacts.count_contacts[world, KNOWN] = settings.shape_count
    contacts.count_contacts[world, SORTED] = 0
    return 0


@func
def keep_overlaps(contacts: Contacts, pairs: Pairs, world: Int32):
    """Save the overlaps of the start of a step before they are changed, for `restore_overlaps`."""
    if pairs.count_pairs[world, START_OVERLAPS] != NONE_KEPT:
        return
    count = contacts.count_contacts[world, OVERLAPS]
    for row in range(count):
        pairs.queue_start[world, row] = read_overlap(contacts, world, row)
    pairs.count_pairs[world, START_OVERLAPS] = count
    pairs.count_pairs[world, START_KNOWN] = contacts.count_contacts[world, KNOWN]
    pairs.count_pairs[world, START_RESETS_SEEN] = contacts.count_contacts[world, RESETS_SEEN]


@func
def restore_overlaps(contacts: Contacts, pairs: Pairs, world: Int32):
    """Restore the overlaps of the start of a step that is abandoned, if they have changed since."""
    count = pairs.count_pairs[world, START_OVERLAPS]
    if count == NONE_KEPT:
        return
    for row in range(count):
        write_overlap(contacts, world, row, pairs.queue_start[world, row])
    contacts.count_contacts[world, OVERLAPS] = count
    contacts.count_contacts[world, KNOWN] = pairs.count_pairs[world, START_KNOWN]
    contacts.count_contacts[world, RESETS_SEEN] = pairs.count_pairs[world, START_RESETS_SEEN]
    contacts.count_contacts[world, SORTED] = 0
