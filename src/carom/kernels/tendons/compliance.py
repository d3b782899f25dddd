"""Rows of user constraints that hold something: rigid ones, and those that yield as MuJoCo's do."""

from carom.kernels.dynamics.yielding import impedance_at, spring_and_damper
from carom.kernels.solver.pair_rows import write_row
from carom.kernels.structs import Model, PairRows, Scratch, Settings, UserConstraints
from carom.kernels.types import Int32, func, real


@func
def is_compliant(users: UserConstraints, user: Int32) -> bool:
    """Whether a user constraint has an impedance; all others are rigid."""
    return users.user_impedance[user][1] > 0.0


@func
def inverse_mass_of(users: UserConstraints, user: Int32, is_turn: bool) -> real:
    """The inverse mass for which rows of a constraint yield, along or about axes; 0 for that at the time."""
    return users.user_inverse_inertia[user] if is_turn else users.user_impedance[user][3]


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
def carried_change(
    model: Model, scratch: Scratch, pair_rows: PairRows, world: Int32, tree: Int32, start: Int32
) -> real:
    """What turning carries a free base along adds to the acceleration of a row, see `integrators.frames`."""
    total = real(0.0)
    first = model.tree[tree].first_dof
    for i in range(3, 6):
        carried = scratch.dof[world, first + i].free_acceleration - scratch.dof[world, first + i].force
        total += pair_rows.entry_row[world, 4 * start + i] * carried
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
    half: real,
    yielding: real,
    lower: real,
    upper: real,
):
    """Write a row of a compliant constraint, whose Jacobian is there already.

    `velocity` is that after the free motion, `error` the row's own, and `size` that of all rows together.
    `tree_b` is -1 if the second tree has no part of its own in the Jacobian. `half` is 0.5 for an angle and
    otherwise 1, since MuJoCo's error is half the angle, but what it yields is as for the whole one: as the
    inverse mass `yielding`, or that of the row if it is 0. The impulse is from `lower` to `upper`.
    """
    h = settings.time_step
    start = pair_rows.row_start[world, row]
    forced = free_change(model, scratch, pair_rows, world, users.user_tree_a[user], start)
    forced += free_change(
        model, scratch, pair_rows, world, tree_b, start + pair_rows.row_place[world, row][1]
    )
    before = velocity - h * forced
    reference, impedance = users.user_reference[user], users.user_impedance[user]
    stiffness, damping = spring_and_damper(settings, reference, impedance)
    d = impedance_at(reference, impedance, size)
    change = before - h * (damping * before + stiffness * d * error) - velocity
    estimated = yielding if yielding > 0.0 else inverse_mass
    softness = estimated * (1.0 - d) / (d * half * half)
    write_row(pair_rows, world, row, inverse_mass, change, softness, lower, upper, 0.0)


@func
def write_holding_row(
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
    half: real,
    erp: real,
):
    """Write a row that stops a motion and corrects its error; see `write_compliant_row`.

    Of a rigid constraint, the share `erp` of what is usual of the error is corrected at once.
    """
    bound = users.user_max_impulse[user]
    if is_compliant(users, user):
        write_compliant_row(
            settings, model, scratch, users, pair_rows, world, user, row, tree_b, inverse_mass, velocity,
            error, size, half, inverse_mass_of(users, user, half < 1.0), -bound, bound,
        )  # fmt: skip
    else:
        change = -velocity - erp * error * settings.joint_erp / settings.time_step
        write_row(pair_rows, world, row, inverse_mass, change, 0.0, -bound, bound, 0.0)
