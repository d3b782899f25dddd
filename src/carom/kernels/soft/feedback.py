"""Effects of soft bodies on trees besides impulses: waking up, and the readings of force-torque sensors."""

import warp as wp

from carom.kernels.dynamics.feedback import add_link_force, note_push
from carom.kernels.solver.activity import is_asleep
from carom.kernels.structs import Model, Scratch, Settings, Shapes, SoftModel, SoftWork, State
from carom.kernels.types import Index4, Int32, Vector3, func, real
from carom.layouts.soft import ANCHORS, BODIES, TOUCHES_PER_FACE, TOUCHES_PER_NODE


@func
def wake(model: Model, state: State, world: Int32, tree: Int32):
    """Wake a sleeping tree from the next substep on, unless it may not wake up."""
    if model.tree[tree].can_wake != 0:
        state.tree_wants_sleep[world, tree] = 0
        state.tree_idle_time[world, tree] = 0.0


@func
def wake_touched(
    model: Model,
    state: State,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    body: Int32,
    node: Int32,
    touch: Int32,
    tree: Int32,
    dt: real,
):
    """Wake a sleeping tree if a node reaches it within a substep, faster than its sleep threshold.

    Trees that touch soft bodies at rest stay asleep.
    """
    if tree >= 0 and model.tree[tree].dof_count > 0 and is_asleep(state, world, tree):
        velocity = state.node_velocity[world, node]
        reach = soft.soft[body].margin + wp.length(velocity) * dt
        if work.touch_offset[world, touch] <= reach:
            if wp.dot(velocity, velocity) >= model.tree[tree].sleep_threshold:
                wake(model, state, world, tree)


@func
def wake_held(model: Model, state: State, soft: SoftModel, world: Int32):
    """Wake sleeping trees that are anchored to soft bodies in motion."""
    for anchor in range(soft.count_soft[ANCHORS]):
        tree = soft.anchor[anchor].tree
        if model.tree[tree].dof_count > 0 and is_asleep(state, world, tree):
            for body in range(soft.count_soft[BODIES]):
                first = soft.soft[body].first_node
                last = first + soft.soft[body].node_count
                if soft.anchor[anchor].node >= first and soft.anchor[anchor].node < last:
                    for node in range(first, last):
                        velocity = state.node_velocity[world, node]
                        if wp.dot(velocity, velocity) >= model.tree[tree].sleep_threshold:
                            wake(model, state, world, tree)


@func
def report_push(
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    force: Vector3,
):
    """Add a force at a point of a link to the readings of its tree's force-torque sensors."""
    if tree >= 0 and model.tree[tree].sensor_count > 0:
        note_push(model, scratch, world, tree)
        add_link_force(state, scratch, world, link, point, force)


@func
def has_touch(work: SoftWork, world: Int32, node: Int32, shape: Int32) -> bool:
    """Whether a node has a touch with a shape."""
    first = TOUCHES_PER_NODE * node
    for touch in range(first, first + work.node_touches[world, node]):
        if work.touch_shape[world, touch] == shape:
            return True
    return False


@func
def shares_of_corners(work: SoftWork, world: Int32, nodes: Index4, weights: Vector3, shape: Int32) -> Vector3:
    """The shares of a force on a face of its corners: those that touch the shape, if any."""
    shares = weights
    for i in range(3):
        if not has_touch(work, world, nodes[i], shape):
            shares[i] = 0.0
    total = shares[0] + shares[1] + shares[2]
    if total <= 0.0:
        return weights
    return shares / total


@func
def report_face_pushes(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
    body: Int32,
):
    """As `report_pushes`, those of a body's faces: each node has a share of the forces on its faces."""
    first = soft.soft[body].first_face
    rows = TOUCHES_PER_NODE * work.node_touches.shape[1]
    for face in range(first, first + soft.soft[body].face_count):
        nodes = soft.face_nodes[face]
        start = rows + TOUCHES_PER_FACE * face
        for touch in range(start, start + work.face_touches[world, face]):
            force = work.touch_impulse[world, touch] / settings.time_step
            shape = work.touch_shape[world, touch]
            shares = shares_of_corners(work, world, nodes, work.touch_weights[world, touch], shape)
            for i in range(3):
                state.node_push[world, nodes[i]] += force * shares[i]
            report_push(
                model, state, scratch, world, shapes.shape_tree[shape], shapes.shape_link[shape],
                work.touch_point[world, touch], -force,
            )  # fmt: skip


@func
def report_pushes(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    scratch: Scratch,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
):
    """Report the pushes of a substep as forces: those on nodes, and on links with force-torque sensors."""
    for body in range(soft.count_soft[BODIES]):
        first = soft.soft[body].first_node
        for node in range(first, first + soft.soft[body].node_count):
            total = Vector3(0.0, 0.0, 0.0)
            start = TOUCHES_PER_NODE * node
            for touch in range(start, start + work.node_touches[world, node]):
                force = work.touch_impulse[world, touch] / settings.time_step
                total += force
                shape = work.touch_shape[world, touch]
                report_push(
                    model, state, scratch, world, shapes.shape_tree[shape], shapes.shape_link[shape],
                    work.touch_point[world, touch], -force,
                )  # fmt: skip
            state.node_push[world, node] = total
        report_face_pushes(settings, shapes, model, state, scratch, soft, work, world, body)
    for anchor in range(soft.count_soft[ANCHORS]):
        report_push(
            model, state, scratch, world, soft.anchor[anchor].tree, soft.anchor[anchor].link,
            work.anchor_point[world, anchor], -work.anchor_impulse[world, anchor] / settings.time_step,
        )  # fmt: skip
