"""Collision detection in finer launches than `collide`, for devices with thousands of threads.

Shapes are placed in parallel, and so are the contact candidates of pairs found. Neighbouring threads have the
same shape, or the pair of the same number, in neighbouring worlds.
"""

import warp as wp

from carom.kernels.contact.bounds import look_ahead, place_shape
from carom.kernels.contact.broad_phase import find_pairs_of_placed
from carom.kernels.contact.collide import (
    accept_contacts,
    accept_pairs,
    add_manifold,
    can_stay,
    find_candidates,
)
from carom.kernels.contact.manifold import comes_before, keep_previous
from carom.kernels.parallel.pair_work import pairs_of_worker, pairs_with_candidates
from carom.kernels.structs import (
    Contacts,
    Model,
    PairResult,
    Pairs,
    PairWork,
    Scratch,
    Settings,
    Shapes,
    State,
)
from carom.kernels.types import Index2, Int32, func, kernel
from carom.layouts.contacts import MEETING, PAIRS, THERE
from carom.layouts.parallel import MAX_CANDIDATES
from carom.layouts.status import STATUS, WELL


@kernel
def shape_bounds_kernel(
    settings: Settings, shapes: Shapes, model: Model, state: State, scratch: Scratch, pairs: Pairs
):
    """Poses and bounds of each shape, and its look-ahead distance for continuous detection."""
    shape, world = wp.tid()
    pairs.shape_motion[world, shape] = look_ahead(shapes, model, settings, state, scratch, world, shape)
    place_shape(shapes, state, pairs, world, shape)


@kernel
def world_pairs_kernel(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    contacts: Contacts,
    pairs: Pairs,
    pair_work: PairWork,
):
    """Find the pairs of shapes whose bounds meet, in each world; keep a copy of the last contacts."""
    world = wp.tid()
    if state.status_entry[world, STATUS] != WELL:
        return
    find_pairs_of_placed(shapes, model, settings, contacts, pairs, world)
    if accept_pairs(settings, shapes, model, state, contacts, pairs, world):
        pair_work.world_kept[world] = keep_previous(contacts, pairs, world)


@func
def first_after(pairs: Pairs, world: Int32, first: Int32, end: Int32, pair: Index2, equal: Int32) -> Int32:
    """The same as `manifold.skip_contacts`, by binary search."""
    low = first + 0
    high = end + 0
    while low < high:
        middle = (low + high) // 2
        if comes_before(pairs, world, middle, pair, equal):
            low = middle + 1
        else:
            high = middle + 0
    return low


@kernel
def pair_candidates_kernel(
    shapes: Shapes, state: State, contacts: Contacts, pairs: Pairs, pair_work: PairWork
):
    """Find the contact candidates of each pair; a worker handles one pair after the other."""
    worker = wp.tid()
    own = pairs_of_worker(pairs, pair_work, worker)
    worlds = pair_work.pair_result.shape[0]
    item = worker + 0
    while item < worlds * pairs.pair_shapes.shape[1]:
        world = item % worlds
        i = item // worlds
        item += pair_work.worker_candidate.shape[0]
        if state.status_entry[world, STATUS] == WELL and i < pairs.count_pairs[world, PAIRS]:
            pair = pairs.pair_shapes[world, i]
            if pairs.pair_nearness[world, i] != MEETING:
                continue
            kept = pair_work.world_kept[world]
            end = kept + contacts.count_contacts[world, THERE]
            first = first_after(pairs, world, kept, end, pair, 0)
            last = first_after(pairs, world, first, end, pair, 1)
            new_points, candidates = find_candidates(
                shapes, own, world, pair, pairs.pair_breaking[world, i], first, last
            )
            result = PairResult()
            result.first = first
            result.end = last
            result.new_points = new_points
            result.candidates = candidates
            pair_work.pair_result[world, i] = result
            for candidate in range(wp.max(new_points, candidates)):
                pair_work.candidate[world, MAX_CANDIDATES * i + candidate] = own.candidate[world, candidate]


@kernel
def world_contacts_kernel(
    shapes: Shapes, model: Model, state: State, contacts: Contacts, pairs: Pairs, pair_work: PairWork
):
    """Make contacts of the candidates of all pairs, in each world; see `collide.make_contacts`."""
    world = wp.tid()
    if state.status_entry[world, STATUS] != WELL:
        return
    kept = pair_work.world_kept[world]
    wanted = Int32(0)
    for i in range(pairs.count_pairs[world, PAIRS]):
        pair = pairs.pair_shapes[world, i]
        if pairs.pair_nearness[world, i] != MEETING:
            continue
        result = pair_work.pair_result[world, i]
        if can_stay(
            shapes, model, state, contacts, world, pair, wanted, result.first - kept, result.end - kept
        ):
            wanted += result.end - result.first
        else:
            wanted = add_manifold(
                shapes, state, contacts, pairs_with_candidates(pairs, pair_work, i), world, pair,
                pairs.pair_breaking[world, i], result.new_points, result.candidates, result.first, result.end,
                wanted,
            )  # fmt: skip
    accept_contacts(state, contacts, world, wanted)
