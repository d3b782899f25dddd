"""Touches of faces within a small step: their impulses on the three nodes of a face and on links."""

import warp as wp

from carom.kernels.maths.min_max import minimum
from carom.kernels.maths.rotation import column
from carom.kernels.soft.contact import (
    PINCHED_RECOVERY,
    RECOVERY,
    are_immovable,
    facing,
    joint_pushes,
    moved_on,
    other_row,
    outwards,
)
from carom.kernels.soft.face_touches import at_weights, first_face_touch
from carom.kernels.soft.pushes import push_along, row_mass, row_velocity
from carom.kernels.soft.tangents import tangents
from carom.kernels.structs import PairRows, Scratch, SoftModel, SoftWork, State
from carom.kernels.types import Index4, Int32, Vector3, func, real

# Greatest speed at which an overlap from before a small step is removed [m/s], as in PyBullet.
_RECOVERY_SPEED = real(0.1)


@func
def shared_mass(soft: SoftModel, nodes: Index4, a: Vector3, b: Vector3) -> real:
    """How much an impulse of 1 N s at the point of a face with weights a moves that with weights b [1/kg]."""
    total = real(0.0)
    for i in range(3):
        total += a[i] * b[i] * soft.node_inverse_mass[nodes[i]]
    return total


@func
def move_face(
    soft: SoftModel, state: State, world: Int32, nodes: Index4, weights: Vector3, impulse: Vector3, h: real
):
    """Move the nodes of a face by an impulse [N s] at one of its points, in a small step."""
    for i in range(3):
        node = nodes[i]
        state.node_position[world, node] += impulse * (weights[i] * soft.node_inverse_mass[node] * h)


@func
def put_outwards(
    soft: SoftModel, state: State, work: SoftWork, world: Int32, nodes: Index4, weights: Vector3, far: Vector3
):
    """Move the nodes of a face without changing their velocities; `far` is per inverse mass [m kg]."""
    for i in range(3):
        node = nodes[i]
        away = far * (weights[i] * soft.node_inverse_mass[node])
        state.node_position[world, node] += away
        work.node_before[world, node] += away


@func
def face_lacking(
    scratch: Scratch, pair_rows: PairRows, state: State, work: SoftWork, world: Int32, nodes: Index4,
    touch: Int32, recovery: real, h: real,
) -> real:  # fmt: skip
    """How much too near a shape a point of a face is at the end of a small step [m]; see `lacking`."""
    row = work.touch_row[world, touch]
    normal = work.touch_normal[world, touch]
    point = work.touch_point[world, touch]
    offset = work.touch_offset[world, touch]
    weights = work.touch_weights[world, touch]
    before = wp.dot(normal, at_weights(work.node_before, world, nodes, weights) - point) - offset
    along = wp.dot(normal, work.touch_velocity[world, touch]) + row_velocity(scratch, pair_rows, world, row)
    gap = wp.dot(normal, at_weights(state.node_position, world, nodes, weights) - point) - offset - h * along
    return minimum(before, 0.0) * (1.0 - minimum(recovery * h, 1.0)) - gap


@func
def relax_face_friction(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, state: State, work: SoftWork, world: Int32,
    nodes: Index4, touch: Int32, mass: real, h: real,
):  # fmt: skip
    """Stop the slip of a face on a shape, as far as impulses within Coulomb's cone can.

    The cone is that of all impulses in this substep. Links that are pressed together, which react to pushes
    after the substep only, push a face in few of its small steps, but hold it in all of them.
    """
    axes = tangents(work.touch_normal[world, touch])
    first, second = column(axes, 1), column(axes, 2)
    total = work.touch_impulse[world, touch]
    bound = wp.dot(total, work.touch_normal[world, touch]) * work.touch_friction[world, touch]
    if bound <= 0.0:
        return
    row = work.touch_row[world, touch]
    row1, row2 = other_row(row, 1), other_row(row, 2)
    weights = work.touch_weights[world, touch]
    moved = at_weights(state.node_position, world, nodes, weights)
    moved -= at_weights(work.node_before, world, nodes, weights)
    slip = moved - work.touch_velocity[world, touch] * h
    slip1 = wp.dot(slip, first) - h * row_velocity(scratch, pair_rows, world, row1)
    slip2 = wp.dot(slip, second) - h * row_velocity(scratch, pair_rows, world, row2)
    before1, before2 = wp.dot(total, first), wp.dot(total, second)
    push1 = before1 - slip1 / (h * (mass + row_mass(pair_rows, world, row1)))
    push2 = before2 - slip2 / (h * (mass + row_mass(pair_rows, world, row2)))
    size = wp.sqrt(push1 * push1 + push2 * push2)
    if size > bound:
        push1, push2 = push1 * bound / size, push2 * bound / size
    push1 -= before1
    push2 -= before2
    along = first * push1 + second * push2
    move_face(soft, state, world, nodes, weights, along, h)
    work.touch_impulse[world, touch] += along
    push_along(scratch, pair_rows, world, row1, -push1)
    push_along(scratch, pair_rows, world, row2, -push2)


@func
def push_face(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, state: State, work: SoftWork, world: Int32,
    nodes: Index4, touch: Int32, mass: real, push: real, h: real,
):  # fmt: skip
    """Push a face off a shape with an impulse [N s], unless that is negative, and apply friction."""
    if push > 0.0:
        along = work.touch_normal[world, touch] * push
        move_face(soft, state, world, nodes, work.touch_weights[world, touch], along, h)
        work.touch_impulse[world, touch] += along
        push_along(scratch, pair_rows, world, work.touch_row[world, touch], -push)
    relax_face_friction(scratch, pair_rows, soft, state, work, world, nodes, touch, mass, h)


@func
def relax_face(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, state: State, work: SoftWork, world: Int32,
    nodes: Index4, touch: Int32, h: real,
):  # fmt: skip
    """Keep a face outside of a shape; see `relax_touch`."""
    weights = work.touch_weights[world, touch]
    mass = shared_mass(soft, nodes, weights, weights)
    weight = mass + row_mass(pair_rows, world, work.touch_row[world, touch])
    if weight > 0.0:
        lack = face_lacking(scratch, pair_rows, state, work, world, nodes, touch, real(0.0), h)
        if mass > 0.0:
            normal = work.touch_normal[world, touch]
            gap = wp.dot(
                normal,
                at_weights(work.node_before, world, nodes, weights) - work.touch_point[world, touch],
            )
            far = outwards(gap - work.touch_offset[world, touch], lack, _RECOVERY_SPEED, h)
            put_outwards(soft, state, work, world, nodes, weights, normal * (far / mass))
        else:
            # No node can be put outwards, so the link has to go.
            lack = face_lacking(scratch, pair_rows, state, work, world, nodes, touch, RECOVERY, h)
        push_face(scratch, pair_rows, soft, state, work, world, nodes, touch, mass, lack / (h * weight), h)


@func
def relax_pinched_face(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, state: State, work: SoftWork, world: Int32,
    nodes: Index4, a: Int32, b: Int32, h: real,
):  # fmt: skip
    """Keep a face outside of two shapes that face each other; see `relax_pinched`."""
    at_a, at_b = work.touch_weights[world, a], work.touch_weights[world, b]
    mass_a, mass_b = shared_mass(soft, nodes, at_a, at_a), shared_mass(soft, nodes, at_b, at_b)
    weight_a = mass_a + row_mass(pair_rows, world, work.touch_row[world, a])
    weight_b = mass_b + row_mass(pair_rows, world, work.touch_row[world, b])
    cross = shared_mass(soft, nodes, at_a, at_b)
    cross *= wp.dot(work.touch_normal[world, a], work.touch_normal[world, b])
    if are_immovable(weight_a, weight_b, cross):
        relax_face(scratch, pair_rows, soft, state, work, world, nodes, a, h)
        relax_face(scratch, pair_rows, soft, state, work, world, nodes, b, h)
    else:
        lack_a = face_lacking(scratch, pair_rows, state, work, world, nodes, a, PINCHED_RECOVERY, h)
        lack_b = face_lacking(scratch, pair_rows, state, work, world, nodes, b, PINCHED_RECOVERY, h)
        push_a, push_b = joint_pushes(lack_a, lack_b, weight_a, weight_b, cross, h)
        push_face(scratch, pair_rows, soft, state, work, world, nodes, a, mass_a, push_a, h)
        push_face(scratch, pair_rows, soft, state, work, world, nodes, b, mass_b, push_b, h)


@func
def relax_face_touches(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, state: State, work: SoftWork, world: Int32,
    body: Int32, h: real,
):  # fmt: skip
    """Relax all touches of a body's faces, one after the other; two that face each other together."""
    first = soft.soft[body].first_face
    for face in range(first, first + soft.soft[body].face_count):
        count = work.face_touches[world, face]
        if count > 0:
            nodes = soft.face_nodes[face]
            start = first_face_touch(work, face)
            left = facing(work, world, start, count)
            for touch in range(count):
                if left < 0 or touch == left:
                    relax_face(scratch, pair_rows, soft, state, work, world, nodes, start + touch, h)
            if left >= 0:
                relax_pinched_face(
                    scratch, pair_rows, soft, state, work, world, nodes, start + (left + 1) % 3,
                    start + (left + 2) % 3, h,
                )  # fmt: skip


@func
def move_face_touches(
    scratch: Scratch, pair_rows: PairRows, soft: SoftModel, work: SoftWork, world: Int32, body: Int32, h: real
):
    """Move the points of the touches of faces with their links for a small step."""
    first = soft.soft[body].first_face
    for face in range(first, first + soft.soft[body].face_count):
        start = first_face_touch(work, face)
        for touch in range(start, start + work.face_touches[world, face]):
            row = work.touch_row[world, touch]
            if row >= 0:
                work.touch_point[world, touch] += moved_on(
                    scratch, pair_rows, world, row, work.touch_velocity[world, touch],
                    tangents(work.touch_normal[world, touch]), h,
                )  # fmt: skip
