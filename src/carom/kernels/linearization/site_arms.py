"""Moment arms of an actuator of a site, and how they and its length change with the positions."""

import warp as wp

from carom.kernels.linearization.dof_motion import find_reach
from carom.kernels.linearization.path_arms import add_force_arms, arms_of, bends_of, write_motion
from carom.kernels.structs import Model, State, StepBatch, StepSpace, UserConstraints
from carom.kernels.tendons.paths import path_orientation, path_position, turn_of
from carom.kernels.tendons.rows import turned_angles
from carom.kernels.types import Int32, Quaternion, Vector3, func, real
from carom.layouts.linearization import MOVES_A, MOVES_B

_SERIES = real(1e-4)


@func
def rotation_vector_rate(turned: Quaternion, spin: Vector3) -> Vector3:
    """Rate of the rotation vector of a quaternion at an angular velocity along the axes before it."""
    axis, angle = turn_of(turned)
    share = real(1.0)
    if angle > _SERIES:
        share = 0.5 * angle / wp.tan(0.5 * angle)
    along = axis * wp.dot(axis, spin)
    return along + (spin - along) * share - 0.5 * angle * wp.cross(axis, spin)


@func
def drop_shared_arms(model: Model, space: StepSpace, steps: StepBatch, place: Int32, reach: Int32):
    """Set the arms of dofs that move both links to 0: they do not change the pose of one to the other."""
    n = space.dofs
    arms, bends = arms_of(space, place), bends_of(space, place)
    for index in range(reach):
        dof = steps.reach[place * n + index]
        if steps.reach_side[place * n + dof] == MOVES_A + MOVES_B:
            steps.change[arms + dof] = 0.0
            for other in range(n):
                steps.step[bends + dof * n + other] = 0.0


@func
def add_site_arms(
    model: Model,
    state: State,
    users: UserConstraints,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    user: Int32,
    gear: real,
) -> real:
    """Add the arms of the wrench of a site, times `gear`, and write the changes of its length; returns that.

    It is what `tendons.rows.add_site_wrench` computes.
    """
    n = space.dofs
    part, second = users.user_first_path[user], users.user_second_path[user]
    has_second = second < part + users.user_path_count[user]
    axis = wp.where(has_second, second, part)
    link, frame = users.path_link[part], users.path_link[axis]
    other = wp.where(has_second, frame, Int32(-1))
    point = path_position(state, world, link, users.path_point[part])
    origin = path_position(state, world, frame, users.path_point[axis])
    turn = path_orientation(state, world, frame, users.path_turn[axis])
    linear, angular = users.user_spring[user], users.user_range[user]
    along = Vector3(linear[0], linear[1], linear[2]) * gear
    about = Vector3(angular[0], angular[1], angular[2]) * gear
    force, torque = wp.quat_rotate(turn, along), wp.quat_rotate(turn, about)
    # How force and torque turn with the frame.
    find_reach(model, space, steps, place, frame, Int32(-1))
    for dof in range(n):
        spin = Vector3(0.0, 0.0, 0.0)
        if steps.reach_side[place * n + dof] != 0:
            spin = steps.axis_angular[place * n + dof]
        steps.turned[3 * place * n + dof] = wp.cross(spin, force)
        steps.turned[(3 * place + 1) * n + dof] = wp.cross(spin, torque)
    reach = find_reach(model, space, steps, place, link, other)
    write_motion(model, space, steps, place, link, point, steps.moved_a, place * n)
    write_motion(model, space, steps, place, other, origin, steps.moved_b, place * n)
    a, b, one = Int32(MOVES_A), Int32(MOVES_B), real(1.0)
    add_force_arms(space, steps, place, reach, a, point, steps.moved_a, force, Int32(0), Int32(0), one)
    add_force_arms(space, steps, place, reach, a, point, steps.moved_a, torque, Int32(1), Int32(1), one)
    length = real(0.0)
    if has_second:
        add_force_arms(space, steps, place, reach, b, origin, steps.moved_b, force, Int32(0), Int32(0), -one)
        add_force_arms(space, steps, place, reach, b, origin, steps.moved_b, torque, Int32(1), Int32(1), -one)
        drop_shared_arms(model, space, steps, place, reach)
        apart = point - origin
        own = path_orientation(state, world, link, users.path_turn[part])
        turned = wp.quat_inverse(turn) * own
        length = wp.dot(force, apart) + wp.dot(about, turned_angles(turned))
        for index in range(reach):
            dof = steps.reach[place * n + index]
            entry = place * n + dof
            spin = Vector3(0.0, 0.0, 0.0)
            if steps.reach_side[entry] & MOVES_A != 0:
                spin += steps.axis_angular[entry]
            if steps.reach_side[entry] & MOVES_B != 0:
                spin -= steps.axis_angular[entry]
            grows = wp.dot(force, steps.moved_a[entry] - steps.moved_b[entry])
            grows += wp.dot(apart, steps.turned[3 * place * n + dof])
            local = wp.quat_rotate_inv(turn, spin)
            grows += wp.dot(about, rotation_vector_rate(turned, local))
            steps.change[arms_of(space, place) + n + dof] = grows
    return length
