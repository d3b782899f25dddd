"""Workspace for solving the islands of a world in parallel: each has its own part.

If islands are solved one after the other, each writes its rows from the start of the arrays. In parallel each
has a *window*: parts of the arrays of `Scratch` and `PairRows` that begin where those of the previous island
end.
"""

import warp as wp

from carom.kernels.structs import IslandWork, PairRows, Scratch, State
from carom.kernels.types import Int32, IntRows, func
from carom.kernels.warp_types import warp_type
from carom.layouts import parallel
from carom.layouts.status import LEFT_OUT, STATUS, WELL

# Parts of a window: rows over one tree, rows to visit, units, manifold blocks, rows over two trees, blocks of
# their Jacobians, matrix blocks of articulated manifold blocks, contact terms, and single contacts of rigid
# bodies.
ROW, VISIT, UNIT, MANIFOLD_BLOCK, PAIR_ROW, JACOBIAN, MATRICES, TERMS, SINGLE = 0, 1, 2, 3, 4, 5, 6, 7, 8

# Stage of an island: its contacts are not written yet; all its rows are written; its rows did not fit.
UNWRITTEN, WRITTEN, GIVEN_UP = 0, 1, 2

Window = warp_type(parallel.Window)


@func
def is_called_off(state: State, world: Int32) -> bool:
    """Whether a world is left out of the step, or had an error and will return to the start of the step."""
    return state.status_entry[world, STATUS] != WELL


@func
def is_at_stage(state: State, work: IslandWork, world: Int32, root: Int32, stage: Int32) -> bool:
    """Whether a tree is the root of an island at a stage, in a world that takes part in the step."""
    if is_called_off(state, world) or state.tree_island[world, root] != root:
        return False
    return work.tree_progress[world, root].stage == stage


@func
def went_wrong(state: State, world: Int32) -> bool:
    """Whether a world has to return to the start of the step: values were not finite, or arrays too short."""
    status = state.status_entry[world, STATUS]
    return status != WELL and status != LEFT_OUT


@func
def window_end(work: IslandWork, world: Int32, root: Int32, part: Int32, capacity: Int32) -> Int32:
    """End of a part of an island's window, at most the length of the array it is in."""
    return wp.min(work.tree_window[world, root][part] + work.tree_room[world, root][part], capacity)


@func
def scratch_of_island(scratch: Scratch, work: IslandWork, world: Int32, root: Int32) -> Scratch:
    """The scratch arrays, with rows restricted to those of an island."""
    first = work.tree_window[world, root][ROW]
    own = Scratch()
    own = scratch
    end = window_end(work, world, root, ROW, scratch.row.shape[1])
    own.row = scratch.row[:, first:end]
    own.row_share = scratch.row_share[:, first:end]
    own.row_softness = scratch.row_softness[:, first:end]
    return own


@func
def pair_rows_of_island(pair_rows: PairRows, work: IslandWork, world: Int32, root: Int32) -> PairRows:
    """The solver's arrays over two trees, restricted to an island's window."""
    first = work.tree_window[world, root]
    own = PairRows()
    own = pair_rows

    row = wp.min(first[PAIR_ROW], pair_rows.row_start.shape[1])
    last_row = window_end(work, world, root, PAIR_ROW, pair_rows.row_start.shape[1])
    own.row_place = pair_rows.row_place[:, row:last_row]
    own.row_start = pair_rows.row_start[:, row:last_row]
    own.row_terms = pair_rows.row_terms[:, row:last_row]
    own.row_bound = pair_rows.row_bound[:, row:last_row]

    block = wp.min(first[JACOBIAN], pair_rows.jacobian_row.shape[1])
    last_block = window_end(work, world, root, JACOBIAN, pair_rows.jacobian_row.shape[1])
    own.jacobian_row = pair_rows.jacobian_row[:, block:last_block]
    own.jacobian_response = pair_rows.jacobian_response[:, block:last_block]
    own.entry_row = pair_rows.entry_row[:, 4 * block : 4 * last_block]
    own.entry_response = pair_rows.entry_response[:, 4 * block : 4 * last_block]

    matrix = wp.min(first[MATRICES], pair_rows.matrix_block.shape[1])
    last_matrix = window_end(work, world, root, MATRICES, pair_rows.matrix_block.shape[1])
    own.matrix_block = pair_rows.matrix_block[:, matrix:last_matrix]
    own.entry_matrix = pair_rows.entry_matrix[:, 4 * matrix : 4 * last_matrix]

    visit = first[VISIT]
    unit = first[UNIT]
    manifold_block = first[MANIFOLD_BLOCK]
    terms = first[TERMS]
    own.visit_row = pair_rows.visit_row[
        :, visit : window_end(work, world, root, VISIT, pair_rows.visit_row.shape[1])
    ]
    own.unit_code = pair_rows.unit_code[
        :, unit : window_end(work, world, root, UNIT, pair_rows.unit_code.shape[1])
    ]
    last_manifold_block = window_end(work, world, root, MANIFOLD_BLOCK, pair_rows.manifold_block.shape[1])
    own.manifold_block = pair_rows.manifold_block[:, manifold_block:last_manifold_block]
    own.side = pair_rows.side[:, 2 * manifold_block : 2 * last_manifold_block]

    single = wp.min(first[SINGLE], pair_rows.single_normal.shape[1])
    last_single = window_end(work, world, root, SINGLE, pair_rows.single_normal.shape[1])
    own.single_contact = pair_rows.single_contact[:, single:last_single]
    own.single_place = pair_rows.single_place[:, single:last_single]
    own.single_impulse = pair_rows.single_impulse[:, single:last_single]
    own.single_softness = pair_rows.single_softness[:, single:last_single]
    own.single_normal = pair_rows.single_normal[:, single:last_single]
    own.single_lateral = pair_rows.single_lateral[:, single:last_single]

    own.terms = work.terms[:, terms : window_end(work, world, root, TERMS, work.terms.shape[1])]
    return own


@func
def state_of_tree(state: State, faults: IntRows, tree: Int32) -> State:
    """The state with a separate entry for a tree's faults, so that the first faulty tree can be reported."""
    own = State()
    own = state
    own.status_entry = faults[:, tree : tree + 1]
    return own
