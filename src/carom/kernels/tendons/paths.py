"""Lengths of tendons, and their moment arms: the Jacobian of the length, along the path."""

import warp as wp

from carom.kernels.joints.coordinates import load_quaternion
from carom.kernels.maths.blocks import add_multiple, dot_product, fill_zero
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.structs import Model, PairRows, Scratch, State, UserConstraints
from carom.kernels.tendons.wrapping import wrapped
from carom.kernels.types import Int32, Quaternion, Vector3, func, real
from carom.layouts.codes import PATH_BALL, PATH_CRANK, PATH_JOINT, PATH_PULLEY, PATH_SITE

_TINY = real(1e-15)


@func
def path_position(state: State, world: Int32, link: Int32, local: Vector3) -> Vector3:
    """World position of a point of a link, or of the world (-1)."""
    return local if link < 0 else wp.transform_point(state.link_pose[world, link], local)


@func
def path_orientation(state: State, world: Int32, link: Int32, local: Quaternion) -> Quaternion:
    """World orientation of a frame of a link, or of the world (-1)."""
    return local if link < 0 else wp.transform_get_rotation(state.link_pose[world, link]) * local


@func
def turn_of(q: Quaternion):
    """Axis and angle, from 0 to pi, of the rotation of a unit quaternion; no axis if it turns nothing."""
    axis = Vector3(q[0], q[1], q[2])
    sine = wp.length(axis)
    if sine == 0.0:
        return Vector3(0.0, 0.0, 0.0), real(0.0)
    if q[3] < 0.0:
        axis = -axis
    return axis / sine, 2.0 * wp.atan2(sine, wp.abs(q[3]))


@func
def add_wrench(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    force: Vector3,
    torque: Vector3,
    start: Int32,
):
    """Add to the row at block `start` the generalised force of a force at a point of a link, and a torque."""
    if link < 0:
        return
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    moment = wp.cross(point - reference, force) + torque
    first = model.tree[tree].first_dof
    dof = model.link[link].nearest_dof
    while dof >= 0:
        pair_rows.entry_row[world, 4 * start + dof - first] += wp.dot(
            scratch.dof[world, dof].linear, force
        ) + wp.dot(scratch.dof[world, dof].angular, moment)
        dof = model.dof[dof].parent


@func
def add_segment(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    link_a: Int32,
    a: Vector3,
    link_b: Int32,
    b: Vector3,
    factor: real,
    start: Int32,
) -> real:
    """Add `factor` times the Jacobian of the distance of two points to a row; returns the distance."""
    zero = Vector3(0.0, 0.0, 0.0)
    distance = wp.length(b - a)
    if distance > _TINY and link_a != link_b:
        pull = (b - a) * (factor / distance)
        add_wrench(model, state, scratch, pair_rows, world, tree, link_a, a, -pull, zero, start)
        add_wrench(model, state, scratch, pair_rows, world, tree, link_b, b, pull, zero, start)
    return distance


@func
def add_crank(
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    part: Int32,
    factor: real,
    start: Int32,
) -> real:
    """Add `factor` times the Jacobian of the position of a slider to a row; returns that position.

    It moves along the z axis of its site, and a rod of a given length connects it to the site that follows.
    Where the rod is too short to reach the axis, its position is that of the point nearest to the other site.
    """
    slider, crank = users.path_link[part], users.path_link[part + 1]
    origin = path_position(state, world, slider, users.path_point[part])
    point = path_position(state, world, crank, users.path_point[part + 1])
    turn = path_orientation(state, world, slider, users.path_turn[part])
    axis = wp.quat_rotate(turn, Vector3(0.0, 0.0, 1.0))
    apart = point - origin
    along = wp.dot(apart, axis)
    rod = users.path_size[part]
    reach = along * along + rod * rod - wp.dot(apart, apart)
    position = along
    by_axis = apart
    by_point = axis
    if reach > 0.0:
        root = wp.sqrt(reach)
        position = along - root
        by_axis = apart * (1.0 - along / root)
        by_point = axis * (1.0 - along / root) + apart / root
    force, torque = by_point * factor, wp.cross(axis, by_axis) * factor
    zero = Vector3(0.0, 0.0, 0.0)
    add_wrench(model, state, scratch, pair_rows, world, tree, crank, point, force, zero, start)
    add_wrench(model, state, scratch, pair_rows, world, tree, slider, origin, -force, torque, start)
    return position


@func
def add_path(
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    first: Int32,
    end: Int32,
    factor: real,
    start: Int32,
) -> real:
    """Add `factor` times the Jacobian of the length of a path to a row; returns the length."""
    total, share = real(0.0), factor * real(1.0)
    divisor = real(1.0)
    link = Int32(-1)
    at = Vector3(0.0, 0.0, 0.0)
    started = Int32(0)
    part = first
    while part < end:
        kind = users.path_kind[part]
        if kind == PATH_JOINT:
            joint = users.path_link[part]
            coefficient = users.path_size[part]
            total += coefficient * state.position[world, model.link[joint].first_position]
            place = model.link[joint].first_dof - model.tree[tree].first_dof
            pair_rows.entry_row[world, 4 * start + place] += factor * coefficient
        elif kind == PATH_BALL:
            joint = users.path_link[part]
            coefficient = users.path_size[part]
            axis, angle = turn_of(load_quaternion(state, world, model.link[joint].first_position))
            total += coefficient * angle
            place = model.link[joint].first_dof - model.tree[tree].first_dof
            for i in range(3):
                pair_rows.entry_row[world, 4 * start + place + i] += factor * coefficient * axis[i]
        elif kind == PATH_CRANK:
            total += add_crank(model, state, scratch, users, pair_rows, world, tree, part, factor, start)
            part += 1
        elif kind == PATH_PULLEY:
            divisor = users.path_size[part]
            share = factor / divisor
            started = Int32(0)
        elif kind == PATH_SITE:
            to = users.path_link[part]
            there = path_position(state, world, to, users.path_point[part])
            if started != 0:
                total += (
                    add_segment(
                        model, state, scratch, pair_rows, world, tree, link, at, to, there, share, start
                    )
                    / divisor
                )
            link = to
            at = there
            started = Int32(1)
        else:
            # A site follows, to which the path goes around this.
            over = users.path_link[part]
            to = users.path_link[part + 1]
            there = path_position(state, world, to, users.path_point[part + 1])
            center = path_position(state, world, over, users.path_point[part])
            turn = path_orientation(state, world, over, users.path_turn[part])
            side = path_position(state, world, users.path_side_link[part], users.path_side_point[part])
            length, begin, finish = wrapped(
                kind, center, turn, users.path_size[part], at, there, side, users.path_has_side[part]
            )
            if length >= 0.0:
                total += (
                    add_segment(
                        model, state, scratch, pair_rows, world, tree, link, at, over, begin, share, start
                    )
                    + length
                ) / divisor
                link = over
                at = finish
        part += 1
    return total


@func
def finish_row(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    start: Int32,
):
    """Write the response of the row at block `start` of a tree; returns its inverse mass and velocity."""
    blocks = tree_blocks(model, tree)
    fill_zero(pair_rows.jacobian_response, start, world, blocks)
    velocity = real(0.0)
    first, matrix = model.tree[tree].first_dof, model.tree[tree].first_block
    for place in range(model.tree[tree].dof_count):
        share = pair_rows.entry_row[world, 4 * start + place]
        if share != 0.0:
            velocity += share * state.dof_velocity[world, first + place]
            add_multiple(
                pair_rows.jacobian_response, start, share, scratch.block_inverse_mass,
                matrix + place * blocks, world, blocks,
            )  # fmt: skip
    inverse_mass = dot_product(
        pair_rows.jacobian_row, start, pair_rows.jacobian_response, start, world, blocks
    )
    return inverse_mass, velocity
