"""Rows of user constraints between two links, linearised: they hold points, directions and orientations."""

import warp as wp

from carom.kernels.linearization.bent_rows import bend_axis, bend_row, find_bending
from carom.kernels.linearization.contact_rows import is_carried
from carom.kernels.linearization.dof_motion import find_reach, point_motion
from carom.kernels.linearization.link_rows import add_row_of_links, add_turning_changes
from carom.kernels.linearization.rows import note_problem, share_left, status_of
from carom.kernels.linearization.soft_rows import (
    ERROR_ITSELF,
    follows_own_mass,
    rigid_law,
    set_error,
    write_mass_changes,
    yielding_law,
)
from carom.kernels.maths.rotation import column, rotation_matrix
from carom.kernels.solver.user_constraints import (
    error_size,
    held_directions,
    held_points,
    held_turn,
    length_of_turn,
    measures_quaternion,
    pose_row,
    user_ends,
    user_row_count,
    world_frame,
)
from carom.kernels.structs import Model, Settings, State, StepBatch, StepSpace, TouchingLinks, UserConstraints
from carom.kernels.tendons.compliance import inverse_mass_of, is_compliant
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import USER_BASE_FRICTION, USER_FIXED, USER_POINT_TO_POINT, USER_PRISMATIC
from carom.layouts.linearization import (
    BASE_FRICTION_ROW,
    CARRIED,
    COMPLIANT_LAW,
    FIXED_ROW,
    MOVES_A,
    MOVES_B,
    POINT_TO_POINT_ROW,
    PRISMATIC_ROW,
    QUARTER_TURN,
    ROW_HOLDS,
)

# Cosines below this are those of quarter turns.
_LEAST = wp.constant(real(1.0e-6))


@func
def euler_rates(turned: Vector3, spin: Vector3, axis: Int32) -> real:
    """Rate of one of the angles (x, y, z) of Rx Ry Rz at an angular velocity along the axes after it."""
    cy, cz, sz = wp.cos(turned[1]), wp.cos(turned[2]), wp.sin(turned[2])
    about_x = (cz * spin[0] - sz * spin[1]) / cy
    about_y = sz * spin[0] + cz * spin[1]
    about_z = spin[2] - wp.sin(turned[1]) * about_x
    return wp.where(axis == 0, about_x, wp.where(axis == 1, about_y, about_z))


@func
def is_quarter_turn(angles: Vector3) -> bool:
    """Whether the second of three angles is a quarter turn, where they have no derivatives."""
    return wp.abs(wp.cos(angles[1])) < _LEAST


@func
def is_pose_constraint(kind: Int32) -> bool:
    """Whether the rows of a user constraint hold two links, or brake a free one."""
    held = kind == USER_PRISMATIC or kind == USER_FIXED or kind == USER_POINT_TO_POINT
    return held or kind == USER_BASE_FRICTION


@func
def row_kind_of(kind: Int32) -> Int32:
    """What rows of such a constraint are called."""
    found = Int32(FIXED_ROW)
    if kind == USER_PRISMATIC:
        found = Int32(PRISMATIC_ROW)
    elif kind == USER_POINT_TO_POINT:
        found = Int32(POINT_TO_POINT_ROW)
    elif kind == USER_BASE_FRICTION:
        found = Int32(BASE_FRICTION_ROW)
    return found


@func
def turning_of(steps: StepBatch, entry: Int32, side: Int32) -> Vector3:
    """Rotation of one of two links by a change of a dof, whose entry in its place is given."""
    turned = Vector3(0.0, 0.0, 0.0)
    if steps.reach_side[entry] & side != 0:
        turned = steps.axis_angular[entry]
    return turned


@func
def turn_of_axis(
    steps: StepBatch, entry: Int32, frame_b: Matrix3, axes: Matrix3, angles: Vector3, axis: Int32
) -> Vector3:
    """Change of an axis of `held_turn`, of a weld that yields, by a change of a dof."""
    turned_b = turning_of(steps, entry, Int32(MOVES_B))
    spin = turning_of(steps, entry, Int32(MOVES_A)) - turned_b
    changes = 0.5 * (wp.transpose(axes) * spin)
    unit = Vector3(0.0, 0.0, 0.0)
    unit[axis] = 1.0
    scalar = -0.25 * wp.dot(wp.transpose(frame_b) * spin, angles)
    return wp.cross(turned_b, column(axes, axis)) + frame_b * (scalar * unit + wp.cross(changes, unit))


@func
def error_change(
    steps: StepBatch,
    entry: Int32,
    direction: Vector3,
    turned_direction: Vector3,
    apart: Vector3,
    axes: Matrix3,
    angles: Vector3,
    axis: Int32,
    is_quaternion: bool,
) -> real:
    """Change of a row's error by a change of a dof; `axis` is that of its angle, -1 for a distance."""
    if axis < 0:
        moved = steps.moved_a[entry] - steps.moved_b[entry]
        return wp.dot(direction, moved) + wp.dot(apart, turned_direction)
    spin = turning_of(steps, entry, Int32(MOVES_A)) - turning_of(steps, entry, Int32(MOVES_B))
    along = wp.transpose(axes) * spin
    return along[axis] if is_quaternion else euler_rates(angles, along, axis)


@func
def write_size_changes(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    reach: Int32,
    target: Int32,
    users: UserConstraints,
    user: Int32,
    apart: Vector3,
    axes: Matrix3,
    angles: Vector3,
):
    """Write derivatives of the size of all errors of a constraint, `error_size`, into `steps.response`."""
    n = space.dofs
    for dof in range(n):
        steps.response[target + dof] = 0.0
    size = error_size(users, user, apart, angles)
    share = length_of_turn(users, user)
    if size > 0.0:
        for index in range(reach):
            dof = steps.reach[place * n + index]
            entry = place * n + dof
            change = wp.dot(apart, steps.moved_a[entry] - steps.moved_b[entry])
            if share > 0.0:
                none = Vector3(0.0, 0.0, 0.0)
                for axis in range(3):
                    turn = error_change(
                        steps, entry, none, none, apart, axes, angles, axis, measures_quaternion(users, user)
                    )
                    change += share * share * angles[axis] * turn
            steps.response[target + dof] = change / size


@func
def add_pose_rows(
    model: Model,
    settings: Settings,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
):
    """Add the rows of a point-to-point, fixed or prismatic constraint, or of the friction of a free body."""
    n = space.dofs
    kind = users.user_kind[user]
    ends = user_ends(users, user)
    is_friction = kind == USER_BASE_FRICTION
    yields = is_friction or is_compliant(users, user)
    point_a, point_b = held_points(state, users, world, user)
    apart = point_a - point_b
    frame_a = world_frame(state, world, ends[0], ends[1], users.user_frame_a[user])
    frame_b = world_frame(state, world, ends[2], ends[3], users.user_frame_b[user])
    axes, angles = held_turn(users, user, frame_a, frame_b)
    is_quaternion = measures_quaternion(users, user)
    directions = held_directions(state, users, world, user, axes)
    held = kind == USER_POINT_TO_POINT or kind == USER_FIXED
    bends = space.law == COMPLIANT_LAW and held and is_compliant(users, user)
    for end in range(2):
        tree = ends[2 * end]
        if tree >= 0:
            if is_carried(model, state, world, tree):
                note_problem(steps, place, CARRIED, user)
    if kind != USER_POINT_TO_POINT and not is_friction and not is_quaternion and is_quarter_turn(angles):
        note_problem(steps, place, QUARTER_TURN, user)
    touch = TouchingLinks()
    touch.known_as = user
    touch.point_a = point_a
    touch.point_b = point_b
    touch.link_a = wp.where(ends[0] < 0, Int32(-1), ends[1])
    touch.link_b = wp.where(ends[2] < 0, Int32(-1), ends[3])
    touch.reach = find_reach(model, space, steps, place, touch.link_a, touch.link_b)
    for index in range(touch.reach):
        entry = place * n + steps.reach[place * n + index]
        none = Vector3(0.0, 0.0, 0.0)
        steps.moved_a[entry] = none
        steps.moved_b[entry] = none
        if steps.reach_side[entry] & MOVES_A != 0:
            steps.moved_a[entry] = point_motion(steps, entry, point_a)
        if steps.reach_side[entry] & MOVES_B != 0:
            steps.moved_b[entry] = point_motion(steps, entry, point_b)
    bent, bent_turn = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    spin = Vector3(0.0, 0.0, 0.0)
    if bends:
        bent, bent_turn, spin = find_bending(
            model, settings, state, space, steps, place, world, touch.reach, touch.link_a, touch.link_b,
            point_a, point_b,
        )  # fmt: skip
    size = real(0.0)
    law = rigid_law(space, settings.joint_erp / settings.time_step)
    size_changes = place * n * space.most_rows + 2 * n
    if yields:
        if not is_friction:
            size = error_size(users, user, apart, angles)
            write_size_changes(
                space, steps, place, touch.reach, size_changes, users, user, apart, axes, angles
            )
        law = yielding_law(settings, users.user_reference[user], users.user_impedance[user], size)
    for number in range(user_row_count(kind)):
        linear, angular, axis = pose_row(kind, directions, axes, number)
        is_turn = wp.where(axis >= 0, Int32(1), Int32(0))
        touch.normal = wp.where(axis >= 0, angular, linear)
        for index in range(touch.reach):
            dof = steps.reach[place * n + index]
            turned = Vector3(0.0, 0.0, 0.0)
            if axis >= 0 and is_quaternion:
                turned = turn_of_axis(steps, place * n + dof, rotation_matrix(frame_b), axes, angles, axis)
            elif axis >= 0 or kind == USER_PRISMATIC:
                # Along axes of the first link.
                turned = wp.cross(turning_of(steps, place * n + dof, Int32(MOVES_A)), touch.normal)
            steps.turned[3 * place * n + dof] = turned
        impulse = state.user_impulse[world, user][number]
        bound = users.user_max_impulse[user]
        if is_friction:
            bound = settings.time_step * users.user_range[user][2]
        row = add_row_of_links(
            settings, space, steps, place, touch, row_kind_of(kind), 0, is_turn, impulse, law[0]
        )
        status = status_of(impulse, -bound, bound)
        entry = row * space.most_rows + row - place * space.most_rows
        steps.row_status[row] = status
        if status != ROW_HOLDS:
            steps.beta[entry] = 1.0
        else:
            steps.alpha[entry] = 1.0
            steps.row_switch[row] = share_left(impulse, -bound, bound)
            error = wp.where(axis >= 0, angles[wp.max(axis, Int32(0))], wp.dot(apart, linear))
            if is_friction:
                error = 0.0
            else:
                for index in range(touch.reach):
                    dof = steps.reach[place * n + index]
                    steps.side[row * space.columns + dof] = error_change(
                        steps, place * n + dof, touch.normal, steps.turned[3 * place * n + dof],
                        apart, axes, angles, axis, is_quaternion,
                    )  # fmt: skip
            stated = inverse_mass_of(users, user, axis >= 0)
            of_row = follows_own_mass(space, yields, stated)
            if of_row:
                stated = write_mass_changes(model, state, space, steps, place, world, row)
                add_turning_changes(space, steps, place, touch, 0, is_turn)
            share = wp.where(yields and axis >= 0 and not is_friction, real(4.0), real(1.0))
            sizes = wp.where(yields and not is_friction, size_changes, ERROR_ITSELF)
            set_error(space, steps, place, row, law, error, sizes, stated, share, of_row)
            if bends:
                bend_row(
                    space, steps, place, touch.reach, row, settings.time_step, touch.normal,
                    wp.where(axis >= 0, bent_turn, bent), is_turn,
                )  # fmt: skip
                if axis >= 0:
                    bend_axis(
                        space, steps, place, touch.reach, row, settings.time_step, touch.normal, spin, error
                    )
