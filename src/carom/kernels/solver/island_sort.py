"""Sorting by island, as Bullet does it: an unstable quicksort, which also moves what has equal keys.

Before each step Bullet sorts its lists of constraints (motors, limits, user constraints) and of manifolds so.
`PairRows.order_row` has the rows to be sorted, of constraints or overlaps, and `order_island` their keys.
"""

import warp as wp

from carom.kernels.solver.activity import is_absent, ties_still_links
from carom.kernels.structs import Model, PairRows, Settings, State, UserConstraints
from carom.kernels.types import Int32, func

# Stack of ranges that are still to be sorted, as pairs of bounds. As the longer range is pushed each time, it
# has at most log2(n) ranges for n rows.
Bounds = wp.types.vector(64, int)


@func
def exchange(pair_rows: PairRows, world: Int32, i: Int32, j: Int32):
    """Swap two rows with their keys."""
    row = pair_rows.order_row[world, i]
    island = pair_rows.order_island[world, i]
    pair_rows.order_row[world, i] = pair_rows.order_row[world, j]
    pair_rows.order_island[world, i] = pair_rows.order_island[world, j]
    pair_rows.order_row[world, j] = row
    pair_rows.order_island[world, j] = island


@func
def sort_by_island(pair_rows: PairRows, world: Int32, count: Int32):
    """Sort the first `count` rows by island: Hoare's quicksort with the middle element as pivot."""
    bounds = Bounds()
    waiting = Int32(0)
    low = Int32(0)
    high = count - 1
    while low < high:
        i = low + 0
        j = high + 0
        pivot = pair_rows.order_island[world, (low + high) // 2]
        while i <= j:
            while pair_rows.order_island[world, i] < pivot:
                i += 1
            while pivot < pair_rows.order_island[world, j]:
                j -= 1
            if i <= j:
                exchange(pair_rows, world, i, j)
                i += 1
                j -= 1
        # The shorter range is sorted next; the other is pushed on the stack.
        if j - low < high - i:
            bounds[waiting] = i
            bounds[waiting + 1] = high
            high = j + 0
        else:
            bounds[waiting] = low
            bounds[waiting + 1] = j
            low = i + 0
        waiting += 2
        while low >= high and waiting > 0:
            waiting -= 2
            low = bounds[waiting]
            high = bounds[waiting + 1]


@func
def sort_constraints(
    settings: Settings,
    model: Model,
    state: State,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
):
    """Write the constraints to `batch_constraint` in the order of relaxation, those of absent trees last."""
    for constraint in range(settings.constraint_count):
        pair_rows.order_row[world, model.constraint[constraint].place] = constraint
    # Absent trees take no part in the sort, which also moves what has equal keys.
    count = Int32(0)
    last = settings.constraint_count + 0
    for place in range(settings.constraint_count):
        constraint = pair_rows.order_row[world, place]
        tree = model.constraint[constraint].tree
        if is_absent(state, world, tree):
            last -= 1
            state.batch_constraint[world, last] = constraint
        else:
            pair_rows.order_row[world, count] = constraint
            number = pair_rows.tree_number[world, tree]
            if ties_still_links(model, users, constraint):
                number = Int32(-1)
            pair_rows.order_island[world, count] = number
            count += 1
    sort_by_island(pair_rows, world, count)
    for place in range(count):
        state.batch_constraint[world, place] = pair_rows.order_row[world, place]
