"""Rows of user constraints: point to point, fixed, prismatic, gear, coupling."""

import warp as wp

from carom.kernels.dynamics.motors import euler_xyz
from carom.kernels.maths.blocks import add_multiple, dot_product, fill_zero, write_multiple
from carom.kernels.maths.rotation import column, rotation_matrix
from carom.kernels.solver.activity import is_in_force
from carom.kernels.solver.bending import bending_between
from carom.kernels.solver.contact_terms import carried_spin, carried_velocity
from carom.kernels.solver.pair_rows import place_row, tree_blocks, write_pair_jacobian, write_row
from carom.kernels.structs import Model, PairRows, Scratch, Settings, State, UserConstraints
from carom.kernels.tendons.compliance import (
    inverse_mass_of,
    is_compliant,
    write_compliant_row,
    write_holding_row,
)
from carom.kernels.tendons.rows import add_path_rows, tendon_limits
from carom.kernels.types import Index4, Int32, Matrix3, Quaternion, Vector3, func, real
from carom.layouts.codes import (
    USER_BASE_FRICTION,
    USER_COUPLING,
    USER_FIXED,
    USER_GEAR,
    USER_POINT_TO_POINT,
    USER_PRISMATIC,
    USER_TENDON,
    USER_TRANSMISSION,
)

_PARALLEL = real(1e-6)


@func
def world_point(state: State, world: Int32, tree: Int32, link: Int32, local: Vector3) -> Vector3:
    """World position of a point given in a link's frame, or in the world frame if `tree` is -1."""
    return local if tree < 0 else wp.transform_point(state.link_pose[world, link], local)


@func
def world_frame(state: State, world: Int32, tree: Int32, link: Int32, local: Quaternion) -> Quaternion:
    """World orientation of a frame given in a link's frame, or in the world frame if `tree` is -1."""
    return local if tree < 0 else wp.transform_get_rotation(state.link_pose[world, link]) * local


@func
def user_row_count(kind: Int32) -> Int32:
    """Number of rows of a user constraint; of a tendon without those of its limits."""
    if kind == USER_BASE_FRICTION:
        return Int32(6)
    if kind == USER_GEAR or kind == USER_COUPLING or kind > USER_TENDON:
        return Int32(1)
    if kind == USER_POINT_TO_POINT:
        return Int32(3)
    if kind == USER_TENDON:
        return Int32(2)
    return Int32(5) if kind == USER_PRISMATIC else Int32(6)


@func
def across_axis(frame: Matrix3, axis: Vector3) -> Vector3:
    """A unit vector perpendicular to `axis`, by the first column of `frame` that is not parallel to it."""
    result = wp.cross(column(frame, 0), axis)
    if wp.length(result) <= _PARALLEL:
        result = wp.cross(column(frame, 1), axis)
    return wp.normalize(result)


@func
def user_ends(users: UserConstraints, user: Int32) -> Index4:
    """Tree and link of a, then of b."""
    return Index4(
        users.user_tree_a[user], users.user_link_a[user], users.user_tree_b[user], users.user_link_b[user]
    )


@func
def held_points(state: State, users: UserConstraints, world: Int32, user: Int32):
    """The pivots of a user constraint on a and on b, in world axes."""
    ends = user_ends(users, user)
    point_a = world_point(state, world, ends[0], ends[1], users.user_pivot_a[user])
    point_b = world_point(state, world, ends[2], ends[3], users.user_pivot_b[user])
    return point_a, point_b


@func
def measures_quaternion(users: UserConstraints, user: Int32) -> bool:
    """Whether angular errors of a user constraint are parts of a quaternion: those of welds that yield."""
    return users.user_kind[user] == USER_FIXED and is_compliant(users, user)


@func
def held_turn(users: UserConstraints, user: Int32, frame_a: Quaternion, frame_b: Quaternion):
    """How a frame on a is turned from the one on b at which a user constraint holds it.

    Of welds that yield the errors are, as in MuJoCo, the vector part of the quaternion from b to a, here
    twice that so that small ones are angles. Their rates are the components of the relative angular velocity
    along axes that are neither of unit length nor across each other, unless the error is small.

    Returns:
        Axes of the angular rows in the world, as columns; the errors [rad].
    """
    axes = rotation_matrix(frame_a)
    between = wp.quat_inverse(frame_b) * frame_a
    turned = Vector3(0.0, 0.0, 0.0)
    if measures_quaternion(users, user):
        if between[3] < 0.0:
            between = Quaternion(-between[0], -between[1], -between[2], -between[3])
        x, y, z, w = between[0], between[1], between[2], between[3]
        axes = rotation_matrix(frame_b) * Matrix3(w, -z, y, z, w, -x, -y, x, w)
        turned = Vector3(2.0 * x, 2.0 * y, 2.0 * z)
    else:
        turned = euler_xyz(rotation_matrix(between))
    return axes, turned


@func
def held_directions(
    state: State, users: UserConstraints, world: Int32, user: Int32, axes: Matrix3
) -> Matrix3:
    """Directions as rows, along which pivots must coincide: all three, or, if prismatic, the first two."""
    directions = wp.identity(3, real)
    if users.user_kind[user] == USER_PRISMATIC:
        along = wp.quat_rotate(
            wp.transform_get_rotation(state.link_pose[world, users.user_link_a[user]]), users.user_axis[user]
        )
        first = across_axis(axes, along)
        second = wp.normalize(wp.cross(along, first))
        directions = wp.matrix_from_rows(first, second, along)
    return directions


@func
def pose_row(kind: Int32, directions: Matrix3, axes: Matrix3, i: Int32):
    """Direction or rotation axis of row `i` of a user constraint.

    Returns:
        The direction of a translational row, else 0; the rotation axis of a rotational row, else 0; the axis'
        column in `axes`, -1 for a translational row.
    """
    linear, angular = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    axis = Int32(-1)
    linear_count = Int32(2) if kind == USER_PRISMATIC else Int32(3)
    first_angle = Int32(2) if kind == USER_PRISMATIC else Int32(0)
    if i < linear_count:
        linear = Vector3(directions[i, 0], directions[i, 1], directions[i, 2])
    else:
        axis = (i - linear_count + first_angle) % 3
        angular = column(axes, axis)
    return linear, angular, axis


@func
def add_user_rows(
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
    bending: Int32,
):
    """Add the rows of one user constraint; returns the next free row and block.

    Each row of a point-to-point, fixed or prismatic constraint stops the motion of a relative to b along or
    about an axis, and corrects a part of the error. Those of the friction of a free body only stop it. If
    `bending` is 1, compliant ones also make up for the acceleration that links have as their rows turn.
    """
    pair_rows.user_first_row[world, user] = row
    if users.user_kind[user] == USER_GEAR:
        row, block = add_gear_row(settings, model, state, scratch, users, pair_rows, world, user, row, block)
        return row, block
    if users.user_kind[user] == USER_COUPLING:
        row, block = add_coupling_row(
            settings, model, state, scratch, users, pair_rows, world, user, row, block
        )
        return row, block
    is_friction = users.user_kind[user] == USER_BASE_FRICTION
    if users.user_kind[user] >= USER_TENDON and not is_friction:
        row, block = add_path_rows(settings, model, state, scratch, users, pair_rows, world, user, row, block)
        return row, block
    ends = user_ends(users, user)
    point_a, point_b = held_points(state, users, world, user)
    apart = point_a - point_b
    frame_a = world_frame(state, world, ends[0], ends[1], users.user_frame_a[user])
    frame_b = world_frame(state, world, ends[2], ends[3], users.user_frame_b[user])
    axes, turned = held_turn(users, user, frame_a, frame_b)
    directions = held_directions(state, users, world, user, axes)

    carried = carried_velocity(model, state, world, ends[0], point_a) - carried_velocity(
        model, state, world, ends[2], point_b
    )
    spin = carried_spin(model, state, world, ends[0]) - carried_spin(model, state, world, ends[2])
    size = error_size(users, user, apart, turned)
    held = users.user_kind[user] == USER_POINT_TO_POINT or users.user_kind[user] == USER_FIXED
    bends = bending == 1 and held and is_compliant(users, user)
    bent, bent_turn = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    square = real(0.0)
    if bends:
        bent, bent_turn, square = bending_between(
            model, settings, state, scratch, world, ends, point_a, point_b
        )
    for i in range(user_row_count(users.user_kind[user])):
        linear, angular, axis = pose_row(users.user_kind[user], directions, axes, i)
        error = turned[axis] if axis >= 0 else wp.dot(apart, linear)
        inverse_mass, velocity, block = write_pair_jacobian(
            model, state, scratch, pair_rows, world, row, block, ends, point_a, point_b, linear, angular
        )
        velocity += wp.dot(carried, linear) + wp.dot(spin, angular)
        if is_friction:
            bound = settings.time_step * users.user_range[user][2]
            write_compliant_row(
                settings, model, scratch, users, pair_rows, world, user, row, ends[2], inverse_mass, velocity,
                real(0.0), real(0.0), real(1.0), inverse_mass_of(users, user, axis >= 0), -bound, bound,
            )  # fmt: skip
        else:
            write_holding_row(
                settings, model, scratch, users, pair_rows, world, user, row, ends[2], inverse_mass, velocity,
                error, size, real(0.5) if axis >= 0 else real(1.0), real(1.0),
            )  # fmt: skip
            if bends:
                change = wp.dot(bent, linear) + wp.dot(bent_turn, angular)
                if axis >= 0:
                    # Axes of `held_turn` turn as the quaternion does, which goes along a circle.
                    change -= 0.25 * square * turned[axis]
                change *= settings.time_step
                share = pair_rows.row_terms[world, row].share
                mass = pair_rows.row_terms[world, row].effective_mass
                pair_rows.row_terms[world, row].share = share - change * mass
        row += 1
    return row, block


@func
def length_of_turn(users: UserConstraints, user: Int32) -> real:
    """What an angular error of a constraint counts beside a distance [m/rad].

    It is halved, as parts of a quaternion are, and that of a weld is multiplied by its `torquescale`.
    """
    found = real(0.0)
    if users.user_kind[user] == USER_FIXED:
        found = 0.5 * users.user_gear_ratio[user]
    elif users.user_kind[user] != USER_POINT_TO_POINT:
        found = real(0.5)
    return found


@func
def error_size(users: UserConstraints, user: Int32, apart: Vector3, turned: Vector3) -> real:
    """Length of the errors of all rows of a constraint."""
    share = length_of_turn(users, user)
    return wp.sqrt(wp.dot(apart, apart) + share * share * wp.dot(turned, turned))


@func
def write_dof_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    dof: Int32,
    share: real,
    start: Int32,
):
    """Write the part of a row that is `share` times a dof's rate; returns its inverse mass and velocity."""
    blocks = (model.tree[tree].dof_count + 3) // 4
    column_of_dof = dof - model.tree[tree].first_dof
    response = model.tree[tree].first_block + column_of_dof * blocks
    fill_zero(pair_rows.jacobian_row, start, world, blocks)
    write_multiple(
        pair_rows.jacobian_response, start, share, scratch.block_inverse_mass, response, world, blocks
    )
    pair_rows.entry_row[world, 4 * start + column_of_dof] = share
    inverse_mass = share * pair_rows.entry_response[world, 4 * start + column_of_dof]
    return inverse_mass, share * state.dof_velocity[world, dof]


@func
def joint_position(model: Model, state: State, world: Int32, link: Int32) -> real:
    """Position of a link's joint."""
    return state.position[world, model.link[link].first_position]


@func
def geared_position(model: Model, state: State, users: UserConstraints, world: Int32, user: Int32) -> real:
    """Position of a gear's joint b, of which an error is taken.

    As in PyBullet it is that of the link of a's body with the number that b has in its own; b's own where
    there is no such link. The two only differ for gears between two bodies.
    """
    link_b = users.user_link_b[user]
    tree_a, tree_b = users.user_tree_a[user], users.user_tree_b[user]
    number = link_b - model.tree[tree_b].first_link
    if number < model.tree[tree_a].link_count:
        link_b = model.tree[tree_a].first_link + number
    position = real(0.0)
    if model.link[link_b].dof_count > 0:
        position = joint_position(model, state, world, link_b)
    return position


@func
def add_gear_row(
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
    """Add a gear's row: rate of joint a + ratio * rate of joint b = rate of the auxiliary joint, or 0."""
    link_a = users.user_link_a[user]
    link_b = users.user_link_b[user]
    auxiliary = users.user_gear_auxiliary[user]
    ratio = users.user_gear_ratio[user]
    error = real(0.0)
    auxiliary_rate = state.dof_velocity[world, model.link[auxiliary].first_dof] if auxiliary >= 0 else 0.0
    if users.user_erp[user] != 0.0:
        angle = joint_position(model, state, world, link_a) + ratio * geared_position(
            model, state, users, world, user
        )
        if auxiliary >= 0:
            angle -= joint_position(model, state, world, auxiliary)
        error = -users.user_erp[user] * (users.user_relative_target[user] - angle)

    after = place_row(model, pair_rows, world, row, users.user_tree_a[user], users.user_tree_b[user], block)
    inverse_mass_a, rate_a = write_dof_jacobian(
        model, state, scratch, pair_rows, world,
        users.user_tree_a[user], model.link[link_a].first_dof, 1.0, block,
    )  # fmt: skip
    start_b = block + pair_rows.row_place[world, row][1]
    inverse_mass_b, rate_b = write_dof_jacobian(
        model, state, scratch, pair_rows, world,
        users.user_tree_b[user], model.link[link_b].first_dof, ratio, start_b,
    )  # fmt: skip
    change = auxiliary_rate - (rate_a + rate_b) - error * settings.joint_erp / settings.time_step
    bound = users.user_max_impulse[user]
    write_row(pair_rows, world, row, inverse_mass_a + inverse_mass_b, change, 0.0, -bound, bound, 0.0)
    return row + 1, after


@func
def coupled_position(state: State, model: Model, users: UserConstraints, world: Int32, user: Int32):
    """Where a coupling wants its follower, and the change of that per change of the leader's position."""
    target, slope = real(0.0), real(0.0)
    if users.user_tree_b[user] >= 0:
        x = joint_position(model, state, world, users.user_link_b[user])
        c = users.user_polynomial[user]
        target = x * (c[0] + x * (c[1] + x * (c[2] + x * c[3])))
        slope = c[0] + x * (2.0 * c[1] + x * (3.0 * c[2] + x * 4.0 * c[3]))
    return users.user_relative_target[user] + target, slope


@func
def add_coupling_row(
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
    """Add a coupling's row: position of joint a = polynomial of that of joint b.

    Joints of one tree share one Jacobian, so that its inverse mass has the terms across both.
    """
    tree_a, tree_b = users.user_tree_a[user], users.user_tree_b[user]
    target, slope = coupled_position(state, model, users, world, user)
    error = joint_position(model, state, world, users.user_link_a[user]) - target
    dof_a = model.link[users.user_link_a[user]].first_dof
    one_tree = tree_b < 0 or tree_b == tree_a
    after = place_row(model, pair_rows, world, row, tree_a, Int32(-1) if one_tree else tree_b, block)
    inverse_mass, rate = write_dof_jacobian(
        model, state, scratch, pair_rows, world, tree_a, dof_a, 1.0, block
    )
    if tree_b >= 0:
        dof_b = model.link[users.user_link_b[user]].first_dof
        if one_tree:
            blocks = tree_blocks(model, tree_a)
            column_b = dof_b - model.tree[tree_a].first_dof
            add_multiple(
                pair_rows.jacobian_response, block, -slope, scratch.block_inverse_mass,
                model.tree[tree_a].first_block + column_b * blocks, world, blocks,
            )  # fmt: skip
            pair_rows.entry_row[world, 4 * block + column_b] = -slope
            inverse_mass = dot_product(
                pair_rows.jacobian_row, block, pair_rows.jacobian_response, block, world, blocks
            )
            rate -= slope * state.dof_velocity[world, dof_b]
        else:
            inverse_mass_b, rate_b = write_dof_jacobian(
                model, state, scratch, pair_rows, world, tree_b, dof_b, -slope,
                block + pair_rows.row_place[world, row][1],
            )  # fmt: skip
            inverse_mass += inverse_mass_b
            rate += rate_b
    write_holding_row(
        settings, model, scratch, users, pair_rows, world, user, row, Int32(-1) if one_tree else tree_b,
        inverse_mass, rate, error, error, real(1.0), users.user_erp[user],
    )  # fmt: skip
    return row + 1, after


@func
def keep_user_impulses(
    settings: Settings, state: State, users: UserConstraints, pair_rows: PairRows, world: Int32, user: Int32
):
    """Store the impulses of a user constraint's rows, and the force of an actuator."""
    first = pair_rows.user_first_row[world, user]
    count = user_row_count(users.user_kind[user])
    if users.user_kind[user] == USER_TENDON:
        count += tendon_limits(users, user)
    for i in range(count):
        impulse = real(0.0)
        if is_in_force(state, users, world, user):
            impulse = pair_rows.row_terms[world, first + i].impulse
        state.user_impulse[world, user][i] = impulse
    if users.user_kind[user] == USER_TRANSMISSION:
        force = state.user_impulse[world, user][0] / settings.time_step
        state.actuator_force[world, users.user_actuator[user]] = force
