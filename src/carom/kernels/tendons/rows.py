"""Rows of tendons, of couplings of two tendons, and of actuators of tendons and sites.

All of one tree: the Jacobian of such a row is the moment arms of a path, or a wrench at a site.
"""

import warp as wp

from carom.kernels.dynamics.actuators import actuator_law, law_of_step, within_own_range
from carom.kernels.dynamics.limits import limit_change
from carom.kernels.dynamics.motors import unless_nan
from carom.kernels.dynamics.rows import MIN_INVERSE_MASS
from carom.kernels.integrators.frames import is_off_frame
from carom.kernels.maths.blocks import fill_zero, write_multiple
from carom.kernels.maths.min_max import within_bounds
from carom.kernels.solver.pair_rows import place_row, tree_blocks, write_row
from carom.kernels.structs import Model, PairRows, Scratch, Settings, State, UserConstraints
from carom.kernels.tendons.compliance import (
    carried_change,
    free_change,
    is_compliant,
    write_compliant_row,
    write_holding_row,
)
from carom.kernels.tendons.path_rates import path_acceleration
from carom.kernels.tendons.paths import add_path, add_wrench, finish_row, path_orientation, path_position
from carom.kernels.types import Int32, Quaternion, Vector3, called_func, func, real
from carom.layouts.codes import USER_TENDON, USER_TENDON_COUPLING

_UNBOUNDED = real(1e30)
_WORLD = Int32(-1)


@func
def begin_row(
    model: Model, pair_rows: PairRows, world: Int32, row: Int32, tree: Int32, start: Int32
) -> Int32:
    """Place a row over one tree, with a Jacobian of zeros; returns the next free block."""
    after = place_row(model, pair_rows, world, row, tree, _WORLD, start)
    fill_zero(pair_rows.jacobian_row, start, world, tree_blocks(model, tree))
    return after


@func
def repeat_row(
    model: Model, pair_rows: PairRows, world: Int32, row: Int32, tree: Int32, source: Int32, start: Int32
) -> Int32:
    """Place a row with the Jacobian of the row at block `source`; returns the next free block."""
    after = place_row(model, pair_rows, world, row, tree, _WORLD, start)
    blocks = tree_blocks(model, tree)
    write_multiple(pair_rows.jacobian_row, start, real(1.0), pair_rows.jacobian_row, source, world, blocks)
    write_multiple(
        pair_rows.jacobian_response, start, real(1.0), pair_rows.jacobian_response, source, world, blocks
    )
    return after


@func
def tendon_limits(users: UserConstraints, user: Int32) -> Int32:
    """Number of rows of a tendon's limits: 2 if both can act at once, as their margins overlap, else 1."""
    bounds = users.user_range[user]
    return wp.where(2.0 * bounds[3] > bounds[1] - bounds[0], Int32(2), Int32(1))


@func
def add_tendon_rows(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    row: Int32,
    block: Int32,
):
    """Add the rows of a tendon; returns the next free row and block.

    They are those of spring, damper and armature, of friction, and of the limit, or of both limits.
    """
    h = settings.time_step
    tree = users.user_tree_a[user]
    source = block + 0
    block = begin_row(model, pair_rows, world, row, tree, source)
    length = add_path(
        model, state, scratch, users, pair_rows, world, tree, users.user_first_path[user],
        users.user_second_path[user], real(1.0), source,
    )  # fmt: skip
    inverse_mass, rate = finish_row(model, state, scratch, pair_rows, world, tree, source)

    spring = users.user_spring[user]
    stretch = wp.max(length - spring[3], real(0.0)) + wp.min(length - spring[2], real(0.0))
    terms = users.user_polynomial[user]
    stiffness = real(0.0)
    if stretch != 0.0:
        stiffness = spring[0] + stretch * (terms[0] + stretch * terms[1])
    # A spring that pushes away from its rest has no stable place at the end of the substep.
    explicit = settings.explicit_forces != 0 or stiffness < 0.0
    armature = users.user_armature[user] + 0.0
    yielding = h * (spring[1] + h * stiffness) + armature
    softness, bound = real(0.0), real(0.0)
    impulse = -h * stiffness * stretch
    if explicit:
        yielding = armature
        before = rate - h * free_change(model, scratch, pair_rows, world, tree, source)
        impulse -= h * spring[1] * before
    if armature > 0.0:
        # Its inertia resists what is faster than before the substep, and faster than steady joints move it.
        steady = path_acceleration(
            model, state, scratch, users, world, tree, users.user_first_path[user],
            users.user_second_path[user], h,
        )  # fmt: skip
        if settings.explicit_forces != 0 and is_off_frame(model, tree):
            steady += carried_change(model, scratch, pair_rows, world, tree, source)
        free = free_change(model, scratch, pair_rows, world, tree, source)
        impulse += armature * (rate - h * (free + steady))
    if yielding > 0.0:
        softness = 1.0 / yielding
        bound = _UNBOUNDED
    if explicit and yielding == 0.0:
        change = impulse * inverse_mass
        write_row(pair_rows, world, row, inverse_mass, change, 0.0, impulse, impulse, 0.0)
    else:
        change = impulse * softness - rate
        write_row(pair_rows, world, row, inverse_mass, change, softness, -bound, bound, 0.0)
    row += 1

    block = repeat_row(model, pair_rows, world, row, tree, source, block)
    bound = h * users.user_range[user][2]
    write_row(pair_rows, world, row, inverse_mass, -rate, 0.0, -bound, bound, 0.0)
    row += 1

    margin = users.user_range[user][3]
    below = users.user_range[user][0] + margin - length
    above = length + margin - users.user_range[user][1]
    limits = tendon_limits(users, user)
    for limit in range(limits):
        block = repeat_row(model, pair_rows, world, row, tree, source, block)
        lower, upper, change, error = real(0.0), real(0.0), real(0.0), real(0.0)
        if below >= 0.0 and limit == 0:
            change = limit_change(settings, below) - rate
            upper = _UNBOUNDED
            error = -below
        elif above >= 0.0 and limit == limits - 1:
            change = -limit_change(settings, above) - rate
            lower = -_UNBOUNDED
            error = above
        if is_compliant(users, user):
            write_compliant_row(
                settings, model, scratch, users, pair_rows, world, user, row, _WORLD, inverse_mass, rate,
                error, error, real(1.0), users.user_impedance[user][3], lower, upper,
            )  # fmt: skip
        else:
            write_row(pair_rows, world, row, inverse_mass, change, 0.0, lower, upper, 0.0)
        row += 1
    return row, block


@func
def add_tendon_coupling_row(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    row: Int32,
    block: Int32,
):
    """Add a row that holds the length of a tendon at a polynomial of that of another one."""
    tree = users.user_tree_a[user]
    first, second = users.user_first_path[user], users.user_second_path[user]
    end = first + users.user_path_count[user]
    after = begin_row(model, pair_rows, world, row, tree, block)
    wanted, slope = users.user_relative_target[user] + 0.0, real(0.0)
    if second < end:
        other = add_path(model, state, scratch, users, pair_rows, world, tree, second, end, real(0.0), block)
        x = other - users.user_range[user][1]
        c = users.user_polynomial[user]
        wanted += x * (c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        slope = c[0] + x * (2.0 * c[1] + x * (3.0 * c[2] + x * 4.0 * c[3]))
        other = add_path(model, state, scratch, users, pair_rows, world, tree, second, end, -slope, block)
    length = add_path(model, state, scratch, users, pair_rows, world, tree, first, second, real(1.0), block)
    inverse_mass, rate = finish_row(model, state, scratch, pair_rows, world, tree, block)
    error = length - users.user_range[user][0] - wanted
    write_holding_row(
        settings, model, scratch, users, pair_rows, world, user, row, _WORLD, inverse_mass, rate, error,
        error, real(1.0), users.user_erp[user],
    )  # fmt: skip
    return row + 1, after


@func
def turned_angles(q: Quaternion) -> Vector3:
    """Rotation vector of a quaternion."""
    axis = Vector3(q[0], q[1], q[2])
    sine = wp.length(axis)
    if sine == 0.0:
        return Vector3(0.0, 0.0, 0.0)
    cosine = q[3]
    if cosine < 0.0:
        sine = -sine
        cosine = -cosine
    return axis * (2.0 * wp.atan2(wp.abs(sine), cosine) / sine)


@func
def add_site_wrench(
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    gear: real,
    start: Int32,
) -> real:
    """Add the Jacobian of a transmission to a site to a row; returns the length of the actuator.

    Its wrench is along the axes of the site, or of a second one, relative to which it then moves the first.
    """
    tree, part = users.user_tree_a[user], users.user_first_path[user]
    axis, second = part + 0, users.user_second_path[user]
    has_second = second < part + users.user_path_count[user]
    if has_second:
        axis = second + 0
    link = users.path_link[part]
    point = path_position(state, world, link, users.path_point[part])
    turn = path_orientation(state, world, users.path_link[axis], users.path_turn[axis])
    linear, angular = users.user_spring[user], users.user_range[user]
    along = Vector3(linear[0], linear[1], linear[2]) * gear
    about = Vector3(angular[0], angular[1], angular[2]) * gear
    force, torque = wp.quat_rotate(turn, along), wp.quat_rotate(turn, about)
    add_wrench(model, state, scratch, pair_rows, world, tree, link, point, force, torque, start)
    if not has_second:
        return real(0.0)
    other = users.path_link[second]
    origin = path_position(state, world, other, users.path_point[second])
    add_wrench(model, state, scratch, pair_rows, world, tree, other, origin, -force, -torque, start)
    # Joints that move both do not change the pose of one relative to the other.
    shared = Int32(-1)
    if other >= 0:
        shared = model.link[other].nearest_dof
    while shared >= 0:
        own = Int32(-1)
        if link >= 0:
            own = model.link[link].nearest_dof
        while own >= 0:
            if own == shared:
                pair_rows.entry_row[world, 4 * start + own - model.tree[tree].first_dof] = real(0.0)
            own = model.dof[own].parent
        shared = model.dof[shared].parent
    own_turn = path_orientation(state, world, link, users.path_turn[part])
    apart = wp.quat_rotate_inv(turn, point - origin)
    return wp.dot(along, apart) + wp.dot(about, turned_angles(wp.quat_inverse(turn) * own_turn))


@func
def share_of_tendon(
    model: Model, state: State, world: Int32, actuator: Int32, length: real, rate: real, h: real
) -> real:
    """By what the forces of all actuators of a tendon are multiplied, so that their sum is within its bounds.

    `length` and `rate` are those of one of them. The forces are those at the present velocity, without their
    own bounds, which come after. `h` is the length of a substep.
    """
    least, greatest = model.actuator_joint_lower[world, actuator], model.actuator_joint_upper[world, actuator]
    if least <= -_UNBOUNDED and greatest >= _UNBOUNDED:
        return real(1.0)
    gear = model.actuator_gear[world, actuator]
    total = real(0.0)
    other = actuator - model.actuator[actuator].follows
    while other >= 0:
        ratio = model.actuator_gear[world, other] / gear
        force, _stiffness, damping = actuator_law(model, state, world, other, ratio * length, ratio * rate, h)
        total += force - damping * ratio * rate
        step = model.actuator[other].to_next + 0
        other = wp.where(step > 0, other + step, Int32(-1))
    if total > greatest and total != 0.0:
        return greatest / total
    if total < least and total != 0.0:
        return least / total
    return real(1.0)


@func
def add_transmission_row(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    row: Int32,
    block: Int32,
):
    """Add the row of an actuator of a tendon or a site, as that of an actuator of a joint.

    One of a tendon whose actuators' forces are bounded as a whole exerts its share of the bound.
    """
    h = settings.time_step
    tree, actuator = users.user_tree_a[user], users.user_actuator[user]
    gear = model.actuator_gear[world, actuator]
    after = begin_row(model, pair_rows, world, row, tree, block)
    length = real(0.0)
    if users.user_is_wrench[user] != 0:
        length = add_site_wrench(model, state, scratch, users, pair_rows, world, user, gear, block)
    else:
        length = gear * add_path(
            model, state, scratch, users, pair_rows, world, tree, users.user_first_path[user],
            users.user_second_path[user], gear, block,
        )  # fmt: skip
    inverse_mass, rate = finish_row(model, state, scratch, pair_rows, world, tree, block)
    before = rate + 0.0
    if settings.explicit_forces != 0:
        before -= h * free_change(model, scratch, pair_rows, world, tree, block)
    force, stiffness, damping = law_of_step(model, settings, state, world, actuator, length, before)
    lower, upper = model.actuator_force_lower[world, actuator], model.actuator_force_upper[world, actuator]
    yielding = h * (damping + h * stiffness)
    share = real(1.0)
    if users.user_is_wrench[user] == 0:
        share = share_of_tendon(model, state, world, actuator, length, before, h)
    if share != 1.0 or inverse_mass <= MIN_INVERSE_MASS:
        impulse = h * within_own_range(model, world, actuator, share * (force - damping * before))
        write_row(pair_rows, world, row, inverse_mass, impulse * inverse_mass, 0.0, impulse, impulse, 0.0)
        if inverse_mass <= MIN_INVERSE_MASS:
            # It accelerates nothing; the row only tells the force.
            pair_rows.row_terms[world, row].impulse = impulse
    elif yielding == 0.0:
        impulse = unless_nan(within_bounds(h * force, h * lower, h * upper), force)
        write_row(pair_rows, world, row, inverse_mass, impulse * inverse_mass, 0.0, impulse, impulse, 0.0)
    else:
        softness = 1.0 / yielding
        write_row(
            pair_rows, world, row, inverse_mass, h * force * softness - rate, softness, h * lower, h * upper,
            0.0,
        )  # fmt: skip
    return row + 1, after


@called_func
def add_path_rows(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    user: Int32,
    row: Int32,
    block: Int32,
):
    """Add the rows of a constraint along paths; returns the next free row and block."""
    if users.user_kind[user] == USER_TENDON:
        row, block = add_tendon_rows(
            settings, model, state, scratch, users, pair_rows, world, user, row, block
        )
        return row, block
    if users.user_kind[user] == USER_TENDON_COUPLING:
        row, block = add_tendon_coupling_row(
            settings, model, state, scratch, users, pair_rows, world, user, row, block
        )
        return row, block
    row, block = add_transmission_row(
        settings, model, state, scratch, users, pair_rows, world, user, row, block
    )
    return row, block
