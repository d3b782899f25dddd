"""Pose and velocity of a soft body as a whole: those of the tree that represents it."""

import warp as wp

from carom.kernels.dynamics.quarantine import report_fault
from carom.kernels.dynamics.single_body import is_single_body
from carom.kernels.joints.coordinates import load_quaternion, three_numbers
from carom.kernels.maths.rotation import column
from carom.kernels.structs import Model, SoftModel, State
from carom.kernels.types import Int32, Matrix3, Quaternion, Transform, Vector3, func, real
from carom.layouts.soft import ANCHORS

# Rotations are found by iteration from the last one: most iterations, and the angle that ends them [rad].
_MAX_TURNS = 20
_MIN_TURN = real(1.0e-10)
# Avoids division by zero if all nodes are in one place or on a line.
_TINY = real(1.0e-12)


@func
def counts(soft: SoftModel, node: Int32) -> real:
    """Weight of a node: 1 if it moves, 0 if it is fixed in the world and has no mass."""
    return wp.where(soft.node_inverse_mass[node] > 0.0, real(1.0), real(0.0))


@func
def turned(start: Quaternion, matrix: Matrix3) -> Quaternion:
    """The rotation nearest to a matrix of moments (Müller, Bender, Chentanez, Macklin, 2016).

    The matrix is the sum of the outer products of positions and positions at rest; `start` is a rotation near
    it.
    """
    q = wp.normalize(start)
    turning = Int32(0)
    while turning < _MAX_TURNS:
        frame = wp.quat_to_matrix(q)
        torque = Vector3(0.0, 0.0, 0.0)
        weight = real(0.0)
        for axis in range(3):
            torque += wp.cross(column(frame, axis), column(matrix, axis))
            weight += wp.dot(column(frame, axis), column(matrix, axis))
        rate = torque / (wp.abs(weight) + _TINY)
        angle = wp.length(rate)
        turning += 1
        if angle > _MIN_TURN:
            q = wp.normalize(wp.quat_from_axis_angle(rate / angle, angle) * q)
        else:
            turning = Int32(_MAX_TURNS)
    return q


@func
def report_nodes(state: State, soft: SoftModel, world: Int32, body: Int32):
    """Report a body as faulty if the position or velocity of a node is not finite."""
    first = soft.soft[body].first_node
    total = Vector3(0.0, 0.0, 0.0)
    for node in range(first, first + soft.soft[body].node_count):
        total += state.node_position[world, node] + state.node_velocity[world, node]
    report_fault(state, world, soft.soft[body].tree, total[0] + total[1] + total[2])


@func
def carry_nodes(model: Model, state: State, soft: SoftModel, world: Int32, body: Int32):
    """Put the nodes of a body that are anchored to single bodies at their points, after integration."""
    first = soft.soft[body].first_node
    last = first + soft.soft[body].node_count
    for anchor in range(soft.count_soft[ANCHORS]):
        node = soft.anchor[anchor].node
        tree = soft.anchor[anchor].tree
        if node >= first and node < last and is_single_body(model, tree):
            place = model.tree[tree].first_position
            turn = load_quaternion(state, world, place + 3)
            arm = wp.quat_rotate(turn, soft.anchor[anchor].pivot)
            state.node_position[world, node] = three_numbers(state.position, world, place) + arm


@func
def follow_nodes(model: Model, state: State, soft: SoftModel, world: Int32, body: Int32):
    """Set the pose and velocity of the tree that represents a body from its nodes.

    The position is the centre of mass of the nodes. The orientation is the rotation that brings the shape at
    rest nearest to their positions.
    """
    first = soft.soft[body].first_node
    last = first + soft.soft[body].node_count
    mass = real(0.0)
    center = Vector3(0.0, 0.0, 0.0)
    velocity = Vector3(0.0, 0.0, 0.0)
    everywhere = Vector3(0.0, 0.0, 0.0)
    for node in range(first, last):
        share = counts(soft, node)
        mass += share
        center += state.node_position[world, node] * share
        velocity += state.node_velocity[world, node] * share
        everywhere += state.node_position[world, node]
    if mass > 0.0:
        center = center / mass
        velocity = velocity / mass
    else:
        center = everywhere / real(last - first)
    moments = Matrix3(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    inertia = wp.identity(3, real) * _TINY
    spin = Vector3(0.0, 0.0, 0.0)
    for node in range(first, last):
        arm = state.node_position[world, node] - center
        moments += wp.outer(arm, soft.node_rest[node])
        share = counts(soft, node)
        inertia += (wp.identity(3, real) * wp.dot(arm, arm) - wp.outer(arm, arm)) * share
        spin += wp.cross(arm, state.node_velocity[world, node] - velocity) * share
    tree = soft.soft[body].tree
    place = model.tree[tree].first_position
    turn = turned(load_quaternion(state, world, place + 3), moments)
    rate = wp.inverse(inertia) * spin
    rates = model.tree[tree].first_velocity
    for axis in range(3):
        state.position[world, place + axis] = center[axis]
        state.dof_velocity[world, rates + axis] = rate[axis]
        state.dof_velocity[world, rates + 3 + axis] = velocity[axis]
    for i in range(4):
        state.position[world, place + 3 + i] = turn[i]
    state.link_pose[world, model.tree[tree].first_link] = Transform(center, turn)
