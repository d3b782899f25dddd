"""Collisions between nodes and faces of soft bodies: of different bodies, and of one with itself.

Once in each substep nodes are sorted into the cells of a grid, and the nodes near each face are found. For
each node the nearest faces are stored, with the side on which the node is. In the small steps the node is
kept on that side, at a distance from the face.
"""

import warp as wp

from carom.kernels.contact.filters import links_may_collide
from carom.kernels.maths.min_max import greatest_entry, lower_corner, maximum, minimum, upper_corner
from carom.kernels.maths.rotation import column
from carom.kernels.soft.nearest import face_normal, on_triangle, sign_of
from carom.kernels.structs import Model, Settings, Shapes, SoftModel, SoftWork, State
from carom.kernels.types import Index4, Int32, Matrix3, Vector3, func, real
from carom.layouts.soft import BODIES, BUCKETS, FACES_PER_NODE

_TINY = real(1.0e-12)
# Faces that extend over more cells are skipped: their corners have flown apart, and a search of so many
# cells would take too long.
_WIDEST = real(32.0)
# Longest motion in a substep that the search allows for, in cells. A faster contact may be found too late.
_FARTHEST = real(4.0)
# Least barycentric coordinate at which a node is above a face. It is negative, which extends faces a little
# beyond their edges, so that a node right above another node is above some face.
_BESIDE = real(-0.05)
# Factors of the coordinates of a cell in its hash: large primes, as in Teschner et al. (2003).
_HASH_X, _HASH_Y, _HASH_Z = wp.constant(73856093), wp.constant(19349663), wp.constant(83492791)


@func
def cell_of(place: real, size: real) -> Int32:
    """Index along one axis of the cell that contains a coordinate."""
    return Int32(wp.clamp(wp.floor(place / size), -1.0e6, 1.0e6))


@func
def bucket_of(x: Int32, y: Int32, z: Int32) -> Int32:
    """The bucket that lists the nodes of a cell."""
    mixed = (x * _HASH_X) ^ (y * _HASH_Y) ^ (z * _HASH_Z)
    return mixed & (BUCKETS - 1)


@func
def list_nodes(soft: SoftModel, state: State, work: SoftWork, world: Int32, size: real) -> real:
    """Sort the nodes of all bodies into the cells of a grid; returns the greatest speed of a node [m/s]."""
    top_speed = real(0.0)
    for bucket in range(BUCKETS):
        work.bucket_first[world, bucket] = -1
    for body in range(soft.count_soft[BODIES]):
        first = soft.soft[body].first_node
        for node in range(first, first + soft.soft[body].node_count):
            work.node_faces[world, node] = 0
            place = state.node_position[world, node]
            bucket = bucket_of(cell_of(place[0], size), cell_of(place[1], size), cell_of(place[2], size))
            work.node_body[world, node] = body
            work.node_next[world, node] = work.bucket_first[world, bucket]
            work.bucket_first[world, bucket] = node
            top_speed = maximum(top_speed, wp.length(state.node_velocity[world, node]))
    return top_speed


@func
def grid_size(soft: SoftModel, state: State, world: Int32) -> real:
    """Size of the cells [m]: mean length of the faces' first edges, plus four times the largest thickness."""
    total, count, thickness = real(0.0), real(0.0), real(0.0)
    for body in range(soft.count_soft[BODIES]):
        first = soft.soft[body].first_face
        thickness = maximum(thickness, soft.soft[body].thickness)
        for face in range(first, first + soft.soft[body].face_count):
            corners = soft.face_nodes[face]
            a = state.node_position[world, corners[0]]
            total += wp.length(state.node_position[world, corners[1]] - a)
            count += 1.0
    return total / maximum(count, 1.0) + 4.0 * thickness + _TINY


@func
def may_near(
    shapes: Shapes, model: Model, settings: Settings, soft: SoftModel, body: Int32, other: Int32
) -> bool:
    """Whether the nodes of one body collide with the faces of another, or with its own."""
    if body == other:
        return soft.soft[body].self_collision != 0
    a = model.tree[soft.soft[body].tree].first_link
    b = model.tree[soft.soft[other].tree].first_link
    return links_may_collide(shapes, settings, a, b)


@func
def face_frame(state: State, world: Int32, corners: Index4) -> Matrix3:
    """The corners of a face, as columns."""
    return wp.matrix_from_cols(
        state.node_position[world, corners[0]],
        state.node_position[world, corners[1]],
        state.node_position[world, corners[2]],
    )


@func
def note_face(work: SoftWork, world: Int32, node: Int32, face: Int32, side: real, distance: real):
    """Store a face among the nearest faces of a node, unless there is no room and all of them are nearer."""
    first = FACES_PER_NODE * node
    count = work.node_faces[world, node]
    place = first + count
    if count >= FACES_PER_NODE:
        place = Int32(-1)
        most = distance + 0.0
        for near in range(first, first + FACES_PER_NODE):
            if work.near_distance[world, near] > most:
                most = work.near_distance[world, near]
                place = near
    else:
        work.node_faces[world, node] = count + 1
    if place >= 0:
        work.near_face[world, place] = face
        work.near_side[world, place] = side
        work.near_distance[world, place] = distance
        work.near_impulse[world, place] = Vector3(0.0, 0.0, 0.0)


@func
def near_at_rest(soft: SoftModel, node: Int32, face: Int32, reach: real) -> bool:
    """Whether a node is nearer than `reach` [m] to a face of its own body in the shape at rest."""
    nodes = soft.face_nodes[face]
    p = soft.node_rest[nodes[0]]
    q = soft.node_rest[nodes[1]]
    r = soft.node_rest[nodes[2]]
    corners = wp.matrix_from_cols(p, q, r)
    point = soft.node_rest[node]
    return wp.length(point - on_triangle(corners, point, face_normal(corners))) < reach


@func
def look_at_node(
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    face: Int32,
    corners: Matrix3,
    normal: Vector3,
    max_distance: real,
    closed: bool,
):
    """Store a face for a node that is within `max_distance` [m] of it.

    The inside of a closed surface is known, so a node that got there is pushed out again. Nodes of the same
    body are left out if they are nearer to the face at rest than the distance at which nodes are kept off it.
    """
    point = state.node_position[world, node]
    offset = point - on_triangle(corners, point, normal)
    distance = wp.length(offset)
    body = work.node_body[world, node]
    usual = body == work.node_body[world, soft.face_nodes[face][0]]
    if usual and distance <= max_distance:
        usual = near_at_rest(soft, node, face, soft.soft[body].thickness)
    if distance <= max_distance and not usual:
        side = 1.0 if closed else sign_of(wp.dot(offset, normal))
        note_face(work, world, node, face, side, distance)


@func
def find_neighbours(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    soft: SoftModel,
    work: SoftWork,
    world: Int32,
):
    """Find the faces near each node: of other soft bodies, and of its own if that has self-collision."""
    size = grid_size(soft, state, world)
    top_speed = list_nodes(soft, state, work, world, size)
    for body in range(soft.count_soft[BODIES]):
        closed = soft.soft[body].tetra_count > 0
        first = soft.soft[body].first_face
        for face in range(first, first + soft.soft[body].face_count):
            nodes = soft.face_nodes[face]
            corners = face_frame(state, world, nodes)
            normal = face_normal(corners)
            a = state.node_position[world, nodes[0]]
            b = state.node_position[world, nodes[1]]
            c = state.node_position[world, nodes[2]]
            fastest = maximum(
                wp.length(state.node_velocity[world, nodes[0]]),
                maximum(
                    wp.length(state.node_velocity[world, nodes[1]]),
                    wp.length(state.node_velocity[world, nodes[2]]),
                ),
            )
            # The nodes that approach the face may be as fast as the fastest of all.
            reach = minimum((fastest + top_speed) * settings.time_step, _FARTHEST * size)
            max_distance = 2.0 * soft.soft[body].thickness + reach
            lower = lower_corner(lower_corner(a, b), c) - Vector3(max_distance, max_distance, max_distance)
            upper = upper_corner(upper_corner(a, b), c) + Vector3(max_distance, max_distance, max_distance)
            if greatest_entry(upper - lower) > _WIDEST * size:
                continue
            for x in range(cell_of(lower[0], size), cell_of(upper[0], size) + 1):
                for y in range(cell_of(lower[1], size), cell_of(upper[1], size) + 1):
                    for z in range(cell_of(lower[2], size), cell_of(upper[2], size) + 1):
                        node = work.bucket_first[world, bucket_of(x, y, z)]
                        while node >= 0:
                            place = state.node_position[world, node]
                            if (
                                cell_of(place[0], size) == x
                                and cell_of(place[1], size) == y
                                and cell_of(place[2], size) == z
                                and node != nodes[0]
                                and node != nodes[1]
                                and node != nodes[2]
                            ):
                                if may_near(shapes, model, settings, soft, work.node_body[world, node], body):
                                    look_at_node(
                                        soft, state, work, world, node, face, corners, normal, max_distance,
                                        closed and work.node_body[world, node] != body,
                                    )  # fmt: skip
                            node = work.node_next[world, node]


@func
def weights_at(corners: Matrix3, point: Vector3) -> Vector3:
    """Barycentric coordinates of a point's projection onto a triangle's plane; some are negative outside."""
    a = column(corners, 0)
    ab = column(corners, 1) - a
    ac = column(corners, 2) - a
    ap = point - a
    normal = wp.cross(ab, ac)
    square = wp.dot(normal, normal) + _TINY * _TINY
    second = wp.dot(wp.cross(ap, ac), normal) / square
    third = wp.dot(wp.cross(ab, ap), normal) / square
    return Vector3(1.0 - second - third, second, third)


@func
def relax_neighbour(
    shapes: Shapes,
    model: Model,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    node: Int32,
    near: Int32,
    h: real,
):
    """Keep a node on its side of a face, at least the thickness away, with friction between them."""
    nodes = soft.face_nodes[work.near_face[world, near]]
    body = soft.soft[work.node_body[world, node]]
    other = soft.soft[work.node_body[world, nodes[0]]]
    corners = face_frame(state, world, nodes)
    point = state.node_position[world, node]
    weights = weights_at(corners, point)
    if weights[0] >= _BESIDE and weights[1] >= _BESIDE and weights[2] >= _BESIDE:
        normal = face_normal(corners) * work.near_side[world, near]
        foot = corners * weights
        thickness = maximum(body.thickness, other.thickness)
        gap = wp.dot(normal, point - foot) - thickness
        if gap < 0.0:
            mass = soft.node_inverse_mass[node]
            total = mass + 0.0
            before = work.node_before[world, node]
            for i in range(3):
                total += weights[i] * weights[i] * soft.node_inverse_mass[nodes[i]]
                before -= work.node_before[world, nodes[i]] * weights[i]
            if total > 0.0:
                # An overlap that existed at the start of the small step is removed slowly.
                start = minimum(wp.dot(normal, before) - thickness, 0.0)
                push = normal * (minimum(start * 0.99 - gap, thickness) / total)
                if start * 0.99 < gap:
                    push = Vector3(0.0, 0.0, 0.0)
                own = model.tree[body.tree].first_link
                others = model.tree[other.tree].first_link
                friction = shapes.link_node_friction[world, own] * shapes.link_node_friction[world, others]
                slip = point - foot - before
                slip -= normal * wp.dot(normal, slip)
                length = wp.length(slip)
                if length > _TINY:
                    bound = friction * wp.length(push)
                    push -= slip * (minimum(bound, length / total) / length)
                work.near_impulse[world, near] += push / h
                state.node_position[world, node] += push * mass
                for i in range(3):
                    state.node_position[world, nodes[i]] -= push * (
                        weights[i] * soft.node_inverse_mass[nodes[i]]
                    )


@func
def relax_neighbours(
    shapes: Shapes,
    model: Model,
    soft: SoftModel,
    state: State,
    work: SoftWork,
    world: Int32,
    body: Int32,
    h: real,
):
    """Keep the nodes of a body off the faces near them, one contact after the other."""
    first = soft.soft[body].first_node
    for node in range(first, first + soft.soft[body].node_count):
        for near in range(FACES_PER_NODE * node, FACES_PER_NODE * node + work.node_faces[world, node]):
            relax_neighbour(shapes, model, soft, state, work, world, node, near, h)
