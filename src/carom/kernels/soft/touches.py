"""Touches (nodes near shapes) and anchors, with their rows over trees: written once in each substep."""

import warp as wp

from carom.kernels.contact.bounds import local_extents
from carom.kernels.contact.filters import links_may_collide
from carom.kernels.dynamics.dynamics import turned_inertia
from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.dynamics.rows import inverse_or_off, inverses_or_off
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.joints.coordinates import three_numbers
from carom.kernels.maths.min_max import lower_corner, maximum, upper_corner
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.soft.feedback import wake_touched
from carom.kernels.soft.nearest import nearest_on_shape
from carom.kernels.soft.pushes import add_push_rows, can_be_pushed, make_ready
from carom.kernels.soft.tangents import tangents
from carom.kernels.structs import (
    Model,
    PairRows,
    Pairs,
    Scratch,
    Settings,
    Shapes,
    SoftModel,
    SoftWork,
    State,
)
from carom.kernels.types import Int32, Vector3, called_func, func, real
from carom.layouts.soft import ANCHORS, TOUCHES_PER_NODE

# Distance beyond the margin at which nodes of any speed have touches, as a share of the margin.
AHEAD = real(1.0)


@func
def point_velocity(
    model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, link: Int32, point: Vector3
) -> Vector3:
    """Velocity of a point of a link that can be pushed [m/s]."""
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    arm = point - reference
    if is_single_body(model, tree):
        return base_velocity(model, state, world, tree) + wp.cross(base_omega(model, state, world, tree), arm)
    velocity = Vector3(0.0, 0.0, 0.0)
    dof = model.link[link].nearest_dof
    while dof >= 0:
        turn = wp.cross(scratch.dof[world, dof].angular, arm)
        velocity += (scratch.dof[world, dof].linear + turn) * state.dof_velocity[world, dof]
        dof = model.dof[dof].parent
    return velocity


@func
def forced_velocity(
    model: Model, state: State, world: Int32, tree: Int32, link: Int32, point: Vector3, time: real
) -> Vector3:
    """Change of the velocity of a point of a single body by external forces in a time [s]; else 0 [m/s]."""
    change = Vector3(0.0, 0.0, 0.0)
    if is_single_body(model, tree):
        wrench = state.link_wrench[world, link]
        force = Vector3(wrench[0], wrench[1], wrench[2])
        torque = Vector3(wrench[3], wrench[4], wrench[5])
        change += force * (time * inverse_or_off(model.link_mass[world, link]))
        if wp.dot(torque, torque) > 0.0:
            pose = state.link_pose[world, link]
            rotation = rotation_matrix(wp.transform_get_rotation(pose))
            inverse = turned_inertia(rotation, inverses_or_off(model.link_inertia[world, link]))
            change += wp.cross(inverse * torque * time, point - wp.transform_get_translation(pose))
    return change


@func
def late_force(soft: SoftModel, tree: Int32) -> real:
    """Share of the external forces on a tree that acts after soft bodies have moved."""
    share = real(0.0)
    for anchor in range(soft.count_soft[ANCHORS]):
        if soft.anchor[anchor].tree == tree:
            share = maximum(share, soft.anchor[anchor].late_force)
    return share


@func
def touched_velocity(
    model: Model,
    state: State,
    scratch: Scratch,
    soft: SoftModel,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    dt: real,
) -> Vector3:
    """Velocity of a point of a link that can be pushed, as what it touches in a substep sees it [m/s].

    Links are assumed to keep their velocity, but for external forces on single bodies.
    """
    velocity = point_velocity(model, state, scratch, world, tree, link, point)
    if is_single_body(model, tree):
        share = late_force(soft, tree)
        velocity += forced_velocity(model, state, world, tree, link, point, (1.0 - share) * dt)
    return velocity


@func
def held_velocity(
    model: Model,
    state: State,
    scratch: Scratch,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    dt: real,
) -> Vector3:
    """Velocity of a point of a link that can be pushed and to which a node is anchored [m/s].

    No motor holds a single body, so it is assumed to move on under the forces on it, as far as they act
    before soft bodies move. Links of other trees are assumed to keep their velocity, as if touched.
    """
    if is_single_body(model, tree):
        first = model.tree[tree].first_velocity
        arm = point - wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        omega = three_numbers(work.dof_start, world, first)
        velocity = three_numbers(work.dof_start, world, first + 3) + wp.cross(omega, arm)
        share = late_force(soft, tree)
        return velocity - forced_velocity(model, state, world, tree, link, point, share * dt)
    return point_velocity(model, state, scratch, world, tree, link, point)


@func
def body_bounds(soft: SoftModel, state: State, world: Int32, body: Int32, dt: real):
    """Bounding box of the nodes of a body throughout a substep, without the margin."""
    first = soft.soft[body].first_node
    lower = state.node_position[world, first]
    upper = lower + Vector3(0.0, 0.0, 0.0)
    for node in range(first, first + soft.soft[body].node_count):
        now = state.node_position[world, node]
        then = now + state.node_velocity[world, node] * dt
        lower = lower_corner(lower_corner(lower, now), then)
        upper = upper_corner(upper_corner(upper, now), then)
    return lower, upper


@func
def keep_nearest(work: SoftWork, world: Int32, first: Int32, count: Int32, distance: real) -> Int32:
    """The row for one more touch of a node: the next free one, or that of the farthest touch.

    It is -1 if there is no free row and no touch is farther away than `distance` [m].
    """
    if count < TOUCHES_PER_NODE:
        return first + count
    place = Int32(-1)
    most = distance + 0.0
    for touch in range(first, first + count):
        if work.touch_offset[world, touch] > most:
            most = work.touch_offset[world, touch]
            place = touch
    return place


@func
def find_node_touches(
    shapes: Shapes,
    state: State,
    pairs: Pairs,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    body: Int32,
    shape: Int32,
    dt: real,
    closing: real,
):
    """Store touches for the nodes of a body that may reach a shape within a substep.

    Until `write_touches`, `touch_offset` is the distance of the node from the shape [m].
    """
    margin = soft.soft[body].margin
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        if soft.node_inverse_mass[node] > 0.0 and soft.node_anchored[node] == 0:
            point = state.node_position[world, node]
            max_distance = margin * (1.0 + AHEAD) + closing + wp.length(state.node_velocity[world, node]) * dt
            lower = pairs.shape_lower[world, shape]
            upper = pairs.shape_upper[world, shape]
            near = Int32(1)
            for axis in range(3):
                if point[axis] < lower[axis] - max_distance or point[axis] > upper[axis] + max_distance:
                    near = Int32(0)
            if near == 1:
                distance, normal = nearest_on_shape(shapes, pairs, world, shape, point, max_distance)
                if distance <= max_distance:
                    place = keep_nearest(
                        work, world, TOUCHES_PER_NODE * node, work.node_touches[world, node], distance
                    )
                    if place >= 0:
                        work.node_touches[world, node] = wp.max(
                            work.node_touches[world, node], place - TOUCHES_PER_NODE * node + 1
                        )
                        work.touch_shape[world, place] = shape
                        work.touch_offset[world, place] = distance
                        work.touch_normal[world, place] = normal


@func
def shape_speed(
    shapes: Shapes, model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, shape: Int32
) -> real:
    """Upper bound of the speeds of a shape's points [m/s]."""
    link = shapes.shape_link[shape]
    if not can_be_pushed(model, state, world, tree, link):
        return 0.0
    pose = state.link_pose[world, link] * shapes.shape_pose[shape]
    center = wp.transform_get_translation(pose)
    velocity = point_velocity(model, state, scratch, world, tree, link, center)
    spin = real(0.0)
    if is_single_body(model, tree):
        spin = wp.length(base_omega(model, state, world, tree))
    else:
        dof = model.link[link].nearest_dof
        while dof >= 0:
            spin += wp.abs(state.dof_velocity[world, dof]) * wp.length(scratch.dof[world, dof].angular)
            dof = model.dof[dof].parent
    return wp.length(velocity) + spin * wp.length(local_extents(shapes, world, shape))


@called_func
def find_touches(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    pairs: Pairs,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    body: Int32,
):
    """Find the shapes that the nodes of a body may touch within a substep."""
    dt = settings.time_step
    own = model.tree[soft.soft[body].tree].first_link
    margin = soft.soft[body].margin
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        work.node_touches[world, node] = 0
    lower, upper = body_bounds(soft, state, world, body, dt)
    for shape in range(settings.shape_count):
        tree = shapes.shape_tree[shape]
        closing = shape_speed(shapes, model, state, scratch, world, tree, shape) * dt
        max_distance = margin * (1.0 + AHEAD) + closing
        near = Int32(1)
        for axis in range(3):
            if (
                lower[axis] - max_distance > pairs.shape_upper[world, shape][axis]
                or upper[axis] + max_distance < pairs.shape_lower[world, shape][axis]
            ):
                near = Int32(0)
        if near == 1 and links_may_collide(shapes, settings, own, shapes.shape_link[shape]):
            find_node_touches(shapes, state, pairs, soft, work, world, body, shape, dt, closing)


@func
def write_touches(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    body: Int32,
    row: Int32,
    block: Int32,
):
    """Complete the touches that have been found for a body, with rows over the trees that they push.

    Rows are written from `row` and `block` on. Returns the next free row and block.
    """
    own = model.tree[soft.soft[body].tree].first_link
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        for touch in range(TOUCHES_PER_NODE * node, TOUCHES_PER_NODE * node + work.node_touches[world, node]):
            shape = work.touch_shape[world, touch]
            link = shapes.shape_link[shape]
            tree = shapes.shape_tree[shape]
            normal = work.touch_normal[world, touch]
            point = state.node_position[world, node] - normal * work.touch_offset[world, touch]
            work.touch_point[world, touch] = point
            work.touch_friction[world, touch] = (
                shapes.link_node_friction[world, own] * shapes.shape_lateral_friction[world, shape]
            )
            work.touch_velocity[world, touch] = Vector3(0.0, 0.0, 0.0)
            work.touch_impulse[world, touch] = Vector3(0.0, 0.0, 0.0)
            work.touch_row[world, touch] = Int32(-1)
            wake_touched(model, state, soft, work, world, body, node, touch, tree, settings.time_step)
            work.touch_offset[world, touch] = soft.soft[body].margin
            if can_be_pushed(model, state, world, tree, link):
                make_ready(model, state, scratch, pair_rows, work, world, tree)
                velocity = touched_velocity(
                    model, state, scratch, soft, world, tree, link, point, settings.time_step
                )
                work.touch_velocity[world, touch] = velocity
                work.touch_row[world, touch] = row
                row, block = add_push_rows(
                    model, state, scratch, pair_rows, world, tree, link, point, tangents(normal), row, block
                )
    return row, block


@func
def write_anchors(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    row: Int32,
    block: Int32,
):
    """Write the anchors, with rows over the trees that they push, from `row` and `block` on.

    Nodes are put where their links have moved.
    """
    for anchor in range(soft.count_soft[ANCHORS]):
        tree = soft.anchor[anchor].tree
        link = soft.anchor[anchor].link
        point = wp.transform_point(state.link_pose[world, link], soft.anchor[anchor].pivot)
        state.node_position[world, soft.anchor[anchor].node] = point
        work.anchor_point[world, anchor] = point
        work.anchor_velocity[world, anchor] = Vector3(0.0, 0.0, 0.0)
        work.anchor_impulse[world, anchor] = Vector3(0.0, 0.0, 0.0)
        work.anchor_row[world, anchor] = Int32(-1)
        if can_be_pushed(model, state, world, tree, link):
            make_ready(model, state, scratch, pair_rows, work, world, tree)
            velocity = held_velocity(
                model, state, scratch, soft, work, world, tree, link, point, settings.time_step
            )
            work.anchor_velocity[world, anchor] = velocity
            work.anchor_row[world, anchor] = row
            row, block = add_push_rows(
                model, state, scratch, pair_rows, world, tree, link, point, wp.identity(3, real), row, block
            )
