"""Touches and anchors within a small step: their impulses on nodes and links."""

import warp as wp

from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.maths.rotation import column
from carom.kernels.soft.pushes import push_along, row_mass, row_velocity
from carom.kernels.soft.tangents import tangents
from carom.kernels.structs import PairRows, Scratch, SoftModel, SoftWork, State
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.soft import ANCHORS, TOUCHES_PER_NODE

# Rate at which a position error from before the small step is removed [1/s]: as with an error reduction of
# 0.2 in each of 240 steps per second.
RECOVERY = real(48.0)
# Greatest speed at which it is removed from a node [m/s]: in PyBullet each of the faces at the node, six of
# them inside of a mesh, adds 0.1 m/s.
_RECOVERY_SPEED = real(0.6)
# The same for a node between two shapes. The motors and contacts that press the shapes together react to
# pushes only after the substep of the soft bodies. So the share of the error that is removed within a
# substep determines how hard the shapes can press without meeting.
PINCHED_RECOVERY = real(200.0)
# Two touches face each other if the dot product of their normals is less than this.
_FACING = real(-0.5)
# Determinant of the inverse masses of two touches, relative to the product of the diagonal, up to which the
# matrix counts as singular.
_SINGULAR = real(1.0e-9)


@func
def other_row(row: Int32, axis: Int32) -> Int32:
    """The row of a touch or anchor along an axis, 0 to 2, given its first row; -1 if it has no rows."""
    return row if row < 0 else row + axis


@func
def lacking(
    scratch: Scratch, pair_rows: PairRows, state: State, work: SoftWork, world: Int32, node: Int32,
    touch: Int32, recovery: real, h: real,
) -> real:  # fmt: skip
    """How much too near a shape a node is at the end of a small step [m]; negative: it is clear of it.

    Of an overlap at the start of the small step only a share has to be removed: `recovery` [1/s] times `h`.
    """
    row = work.touch_row[world, touch]
    normal = work.touch_normal[world, touch]
    point = work.touch_point[world, touch]
    offset = work.touch_offset[world, touch]
    before = wp.dot(normal, work.node_before[world, node] - point) - offset
    along = wp.dot(normal, work.touch_velocity[world, touch]) + row_velocity(scratch, pair_rows, world, row)
    gap = wp.dot(normal, state.node_position[world, node] - point) - offset - h * along
    return minimum(before, 0.0) * (1.0 - minimum(recovery * h, 1.0)) - gap


@func
def push_touch(
    scratch: Scratch,
    pair_rows: PairRows,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    touch: Int32,
    mass: real,
    push: real,
    h: real,
):
    """Push a node off a shape with an impulse [N s], and apply friction within Coulomb's cone."""
    if push > 0.0:
        row = work.touch_row[world, touch]
        normal = work.touch_normal[world, touch]
        state.node_position[world, node] += normal * (push * mass * h)
        work.touch_impulse[world, touch] += normal * push
        push_along(scratch, pair_rows, world, row, -push)
        bound = push * work.touch_friction[world, touch]
        if bound > 0.0:
            relax_friction(scratch, pair_rows, state, work, world, node, touch, row, mass, bound, h)


@func
def outwards(before: real, lack: real, speed: real, h: real) -> real:
    """How far what overlaps a shape is put outwards in a small step, besides its motion [m].

    That is the share of the overlap to be removed, at most as fast as `speed` [m/s], less what its motion
    relative to the shape removes. `before` is the distance before the small step, negative for an overlap,
    and `lack` the loss of distance by motion [m].
    """
    wanted = minimum(-minimum(before, 0.0) * minimum(RECOVERY * h, 1.0), speed * h)
    return maximum(wanted + minimum(lack, 0.0), 0.0)


@func
def relax_touch(
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    touch: Int32,
    h: real,
):
    """Keep a node outside of a shape: the impulse that makes `lacking` zero stops what drives them together.

    An overlap from before is removed without giving the node a velocity.
    """
    mass = soft.node_inverse_mass[node]
    weight = mass + row_mass(pair_rows, world, work.touch_row[world, touch])
    lack = lacking(scratch, pair_rows, state, work, world, node, touch, real(0.0), h)
    normal = work.touch_normal[world, touch]
    before = wp.dot(normal, work.node_before[world, node] - work.touch_point[world, touch])
    before -= work.touch_offset[world, touch]
    away = normal * outwards(before, lack, _RECOVERY_SPEED, h)
    push_touch(scratch, pair_rows, state, work, world, node, touch, mass, lack / (h * weight), h)
    state.node_position[world, node] += away
    work.node_before[world, node] += away


@func
def are_immovable(weight_a: real, weight_b: real, cross: real) -> bool:
    """Whether two pushes cannot be solved together: each moves the place of the other by `cross` [1/kg]."""
    return weight_a * weight_b - cross * cross <= _SINGULAR * weight_a * weight_b


@func
def joint_pushes(lack_a: real, lack_b: real, weight_a: real, weight_b: real, cross: real, h: real):
    """The two impulses [N s], none negative, that together make up for what is lacking at two places [m]."""
    determinant = weight_a * weight_b - cross * cross
    push_a = (lack_a * weight_b - lack_b * cross) / (h * determinant)
    push_b = (lack_b * weight_a - lack_a * cross) / (h * determinant)
    if push_a < 0.0:
        push_a = real(0.0)
        push_b = lack_b / (h * weight_b)
    elif push_b < 0.0:
        push_b = real(0.0)
        push_a = lack_a / (h * weight_a)
    return push_a, push_b


@func
def relax_pinched(
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    a: Int32,
    b: Int32,
    h: real,
):
    """Keep a node outside of two shapes that face each other.

    Both impulses are solved for together. One after the other, each would only be large enough to stop the
    node, however hard the shapes are pressed together: a light node could not keep two heavy links apart.
    """
    mass = soft.node_inverse_mass[node]
    weight_a = mass + row_mass(pair_rows, world, work.touch_row[world, a])
    weight_b = mass + row_mass(pair_rows, world, work.touch_row[world, b])
    cross = mass * wp.dot(work.touch_normal[world, a], work.touch_normal[world, b])
    if are_immovable(weight_a, weight_b, cross):
        # Neither shape can be moved.
        relax_touch(scratch, pair_rows, soft, state, work, world, node, a, h)
        relax_touch(scratch, pair_rows, soft, state, work, world, node, b, h)
    else:
        lack_a = lacking(scratch, pair_rows, state, work, world, node, a, PINCHED_RECOVERY, h)
        lack_b = lacking(scratch, pair_rows, state, work, world, node, b, PINCHED_RECOVERY, h)
        push_a, push_b = joint_pushes(lack_a, lack_b, weight_a, weight_b, cross, h)
        push_touch(scratch, pair_rows, state, work, world, node, a, mass, push_a, h)
        push_touch(scratch, pair_rows, state, work, world, node, b, mass, push_b, h)


@func
def relax_friction(
    scratch: Scratch,
    pair_rows: PairRows,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    touch: Int32,
    row: Int32,
    mass: real,
    bound: real,
    h: real,
):
    """Stop the slip of a node on a shape, as far as an impulse within `bound` [N s] can."""
    normal = work.touch_normal[world, touch]
    axes = tangents(normal)
    first, second = column(axes, 1), column(axes, 2)
    row1, row2 = other_row(row, 1), other_row(row, 2)
    moved = state.node_position[world, node] - work.node_before[world, node]
    slip = moved - work.touch_velocity[world, touch] * h
    slip1 = wp.dot(slip, first) - h * row_velocity(scratch, pair_rows, world, row1)
    slip2 = wp.dot(slip, second) - h * row_velocity(scratch, pair_rows, world, row2)
    push1 = -slip1 / (h * (mass + row_mass(pair_rows, world, row1)))
    push2 = -slip2 / (h * (mass + row_mass(pair_rows, world, row2)))
    size = wp.sqrt(push1 * push1 + push2 * push2)
    if size > bound:
        push1, push2 = push1 * bound / size, push2 * bound / size
    along = first * push1 + second * push2
    state.node_position[world, node] += along * (mass * h)
    work.touch_impulse[world, touch] += along
    push_along(scratch, pair_rows, world, row1, -push1)
    push_along(scratch, pair_rows, world, row2, -push2)


@func
def facing(work: SoftWork, world: Int32, first: Int32, count: Int32) -> Int32:
    """Find two of up to three touches that face each other; returns the number of the third.

    That is 2 if there are only two touches, and -1 if no two face each other.
    """
    if count == 2:
        if wp.dot(work.touch_normal[world, first], work.touch_normal[world, first + 1]) < _FACING:
            return 2
        return -1
    found = Int32(-1)
    least = real(_FACING)
    if count == 3:
        for other in range(3):
            a, b = first + (other + 1) % 3, first + (other + 2) % 3
            along = wp.dot(work.touch_normal[world, a], work.touch_normal[world, b])
            if along < least:
                least = along
                found = Int32(other)
    return found


@func
def relax_touches(
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    body: Int32,
    h: real,
):
    """Relax all touches of a body, one after the other; two that face each other are relaxed together."""
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        start = TOUCHES_PER_NODE * node
        count = work.node_touches[world, node]
        left = facing(work, world, start, count)
        for touch in range(count):
            if left < 0 or touch == left:
                relax_touch(scratch, pair_rows, soft, state, work, world, node, start + touch, h)
        if left >= 0:
            relax_pinched(
                scratch, pair_rows, soft, state, work, world, node, start + (left + 1) % 3,
                start + (left + 2) % 3, h,
            )  # fmt: skip


@func
def relax_anchors(
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    h: real,
):
    """Hold anchored nodes at their points of links."""
    for anchor in range(soft.count_soft[ANCHORS]):
        node = soft.anchor[anchor].node
        row = work.anchor_row[world, anchor]
        mass = soft.node_inverse_mass[node]
        before = work.node_before[world, node] - work.anchor_point[world, anchor]
        for axis in range(3):
            line = other_row(row, axis)
            velocity = work.anchor_velocity[world, anchor][axis] + row_velocity(
                scratch, pair_rows, world, line
            )
            gap = (
                state.node_position[world, node][axis] - work.anchor_point[world, anchor][axis] - h * velocity
            )
            wanted = before[axis] * (1.0 - minimum(RECOVERY * h, 1.0))
            weight = mass + row_mass(pair_rows, world, line)
            if weight > 0.0:
                push = (wanted - gap) / (h * weight)
                state.node_position[world, node][axis] += push * mass * h
                work.anchor_impulse[world, anchor][axis] += push
                push_along(scratch, pair_rows, world, line, -push)


@func
def moved_on(
    scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, velocity: Vector3, axes: Matrix3, h: real
) -> Vector3:
    """Displacement of a point of a link in a small step [m]; its rows act along the columns of `axes`."""
    motion = velocity + Vector3(0.0, 0.0, 0.0)
    if row >= 0:
        for axis in range(3):
            motion += column(axes, axis) * row_velocity(scratch, pair_rows, world, row + axis)
    return motion * h


@func
def move_touches(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, work: SoftWork, world: Int32, body: Int32, h: real
):
    """Move the points of touches with their links for a small step."""
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        for touch in range(TOUCHES_PER_NODE * node, TOUCHES_PER_NODE * node + work.node_touches[world, node]):
            row = work.touch_row[world, touch]
            if row >= 0:
                work.touch_point[world, touch] += moved_on(
                    scratch, pair_rows, world, row, work.touch_velocity[world, touch],
                    tangents(work.touch_normal[world, touch]), h,
                )  # fmt: skip


@func
def move_anchors(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, work: SoftWork, world: Int32, h: real
):
    """Move the points of anchors with their links for a small step."""
    for anchor in range(soft.count_soft[ANCHORS]):
        work.anchor_point[world, anchor] += moved_on(
            scratch, pair_rows, world, work.anchor_row[world, anchor], work.anchor_velocity[world, anchor],
            wp.identity(3, real), h,
        )  # fmt: skip
