"""Compliance of user constraints: how they pull back, and how they yield, as constraints of MuJoCo do.

A compliant constraint is a spring and damper of the relative motion, whatever the masses: without other
forces its error r obeys r'' = -b r' - k d r. A force f on it moves it by the acceleration (1 - d) / d A f.
A is the inverse mass of the row; d, the impedance, grows with the error from one bound to another.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum, within_bounds
from carom.kernels.solver.pair_rows import write_row
from carom.kernels.structs import Model, PairRows, Scratch, Settings, UserConstraints
from carom.kernels.types import Int32, func, real

_MIN_IMPEDANCE, _MAX_IMPEDANCE = real(0.0001), real(0.9999)
_LEAST = real(1e-15)


@func
def is_compliant(users: UserConstraints, user: Int32) -> bool:
    """Whether a user constraint has an impedance; all others are rigid."""
    return users.user_impedance[user][1] > 0.0


@func
def impedance(users: UserConstraints, user: Int32, size: real) -> real:
    """Impedance of a constraint whose error has this size."""
    bounds, curve = users.user_impedance[user], users.user_reference[user]
    first = within_bounds(bounds[0], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    last = within_bounds(bounds[1], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    if bounds[2] <= _LEAST:
        return 0.5 * (first + last)
    x = wp.abs(size) / bounds[2]
    if x >= 1.0:
        return last
    y = x
    midpoint, power = within_bounds(curve[2], _MIN_IMPEDANCE, _MAX_IMPEDANCE), curve[3]
    if power > 1.0:
        if x <= midpoint:
            y = midpoint * wp.pow(x / midpoint, power)
        else:
            y = 1.0 - (1.0 - midpoint) * wp.pow((1.0 - x) / (1.0 - midpoint), power)
    return first + y * (last - first)


@func
def free_change(
    model: Model, scratch: Scratch, pair_rows: PairRows, world: Int32, tree: Int32, start: Int32
) -> real:
    """Acceleration of a tree's part of a row by all forces but those of constraints."""
    total = real(0.0)
    if tree >= 0:
        first = model.tree[tree].first_dof
        for i in range(model.tree[tree].dof_count):
            total += pair_rows.entry_row[world, 4 * start + i] * scratch.dof[world, first + i].force
    return total


@func
def write_compliant_row(
    settings: Settings,
    model: Model,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    row: Int32,
    tree_b: Int32,
    inverse_mass: real,
    velocity: real,
    error: real,
    size: real,
    bound: real,
    half: real,
):
    """Write a row of a compliant constraint, whose Jacobian is there already.

    `velocity` is that after the free motion, `error` the row's own, and `size` that of all rows together.
    `tree_b` is -1 if the second tree has no part of its own in the Jacobian. `half` is 0.5 for an angle and
    otherwise 1, since MuJoCo's error is half the angle, but what it yields is as for the whole one.
    """
    h = settings.time_step
    start = pair_rows.row_start[world, row]
    forced = free_change(model, scratch, pair_rows, world, users.user_tree_a[user], start)
    forced += free_change(
        model, scratch, pair_rows, world, tree_b, start + pair_rows.row_place[world, row][1]
    )
    before = velocity - h * forced
    reference = users.user_reference[user]
    last = within_bounds(users.user_impedance[user][1], _MIN_IMPEDANCE, _MAX_IMPEDANCE)
    stiffness, damping = -reference[0] / (last * last), -reference[1] / last
    if reference[0] > 0.0:
        time_constant = maximum(reference[0], 2.0 * h)
        damping = 2.0 / (last * time_constant)
        stiffness = 1.0 / maximum(_LEAST, wp.pow(last * time_constant * reference[1], real(2.0)))
    d = impedance(users, user, size)
    change = before - h * (damping * before + stiffness * d * error) - velocity
    softness = inverse_mass * (1.0 - d) / (d * half * half)
    write_row(pair_rows, world, row, inverse_mass, change, softness, -bound, bound, 0.0)
