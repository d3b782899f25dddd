"""Stages of a world whose rows are relaxed together with those of others: before and after the sweeps."""

import warp as wp

from carom.kernels.solver.joint_solver import keep_row_results
from carom.kernels.solver.solver import island_rows, keep_constraint_impulses
from carom.kernels.structs import Model, PairRows, Scratch, Settings, State, UserConstraints
from carom.kernels.types import Int32, IntRows, RealRows, func, kernel
from carom.layouts.programs import (
    WAITING_BLOCKS,
    WAITING_PAIR_ROWS,
    WAITING_ROOT,
    WAITING_ROWS,
    WAITING_SWEEPS,
    WAITING_VISITS,
)


@func
def only_island(settings: Settings, state: State, pair_rows: PairRows, world: Int32) -> Int32:
    """Root of the only island with constraints, if there are no contacts; -1 otherwise."""
    root = Int32(-1)
    for tree in range(settings.tree_count):
        if state.tree_island[world, tree] == tree:
            if pair_rows.tree_first_contact[world, tree] >= 0:
                return Int32(-1)
            if pair_rows.tree_first_constraint[world, tree] >= 0:
                if root >= 0:
                    return Int32(-1)
                root = tree + 0
    return root


@kernel
def lane_rows_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    waiting: IntRows,
    first_world: Int32,
):
    """Write the rows of a world's only island, and where they are into `waiting`.

    In worlds with contacts, or with several islands, WAITING_ROOT is -1: `constraints_kernel` solves those.
    """
    world = first_world + wp.tid()
    root = only_island(settings, state, pair_rows, world)
    if root >= 0:
        rows, pair_row, block, visits = island_rows(
            model, settings, state, scratch, users, pair_rows, world, root
        )
        waiting[0, WAITING_ROWS] = rows
        waiting[0, WAITING_PAIR_ROWS] = pair_row
        waiting[0, WAITING_BLOCKS] = block
        waiting[0, WAITING_VISITS] = visits
        if visits <= 0:
            root = Int32(-1)
    waiting[0, WAITING_ROOT] = root


@kernel
def lane_impulses_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    waiting: IntRows,
    residuals: RealRows,
    first_world: Int32,
):
    """Store the impulses of these rows, their numbers of sweeps and their residual."""
    world = first_world + wp.tid()
    root = waiting[0, WAITING_ROOT]
    keep_row_results(
        model, settings, state, scratch, world, root, waiting[0, WAITING_ROWS], waiting[0, WAITING_SWEEPS],
        residuals[0, 0],
    )  # fmt: skip
    keep_constraint_impulses(model, settings, state, users, pair_rows, world, root)
