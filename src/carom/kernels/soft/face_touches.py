"""Touches of faces: faces of soft bodies near shapes, found once in each substep.

A node touches a shape on its own. Between nodes, a corner, an edge or a thin shape meets a face: at the
nearest points of the face's triangle and the shape, by GJK and EPA, as in Bullet. During the substep the
shape is approximated by a plane, as for a node. The touching point of the face has fixed barycentric
coordinates: the weights by which an impulse there is shared among the corners.
"""

import warp as wp

from carom.kernels.contact.filters import links_may_collide
from carom.kernels.maths.min_max import lower_corner, maximum, upper_corner
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.cores import Core
from carom.kernels.shapes.gjk import TOUCHING, nearest_points
from carom.kernels.shapes.polytope import overlap
from carom.kernels.shapes.triangles import (
    first_cursor,
    following_cursor,
    region_of,
    triangle_core,
    triangle_corners,
    triangle_from,
)
from carom.kernels.soft.feedback import has_touch, wake_touched
from carom.kernels.soft.nearest import away_from, face_normal, on_triangle, rounding_of
from carom.kernels.soft.neighbours import face_frame, weights_at
from carom.kernels.soft.pushes import add_push_rows, can_be_pushed, make_ready
from carom.kernels.soft.tangents import tangents
from carom.kernels.soft.touches import AHEAD, body_bounds, keep_nearest, shape_speed, touched_velocity
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
from carom.kernels.types import Index4, Int32, Matrix3, Vector3, Vector3Rows, called_func, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, HULL, PLANE, SPHERE, TRIANGLES
from carom.layouts.soft import ANCHORS, TOUCHES_PER_FACE, TOUCHES_PER_NODE

# Corners of a face with a smaller weight at the touching point have no part in the touch.
_LITTLE = real(1.0e-6)


@func
def first_face_touch(work: SoftWork, face: Int32) -> Int32:
    """First row for the touches of a face; the rows for those of all nodes come before."""
    return TOUCHES_PER_NODE * work.node_touches.shape[1] + TOUCHES_PER_FACE * face


@func
def at_weights(values: Vector3Rows, world: Int32, nodes: Index4, weights: Vector3) -> Vector3:
    """Value at a point of a face with these nodes and barycentric coordinates."""
    total = values[world, nodes[0]] * weights[0]
    total += values[world, nodes[1]] * weights[1]
    total += values[world, nodes[2]] * weights[2]
    return total


@func
def sharp_core(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32) -> Core:
    """A convex shape as it is, without Bullet's margin in or around it, as nodes see it."""
    core = Core()
    core.kind = shapes.shape_kind[shape]
    core.size = shapes.shape_size[world, shape]
    core.position = pairs.shape_position[world, shape]
    core.frame = pairs.shape_frame[world, shape]
    if core.kind == SPHERE or core.kind == CAPSULE:
        core.radius = core.size[0]
    elif core.kind == HULL:
        core.first_vertex = shapes.shape_first_vertex[shape]
        core.vertex_count = shapes.shape_vertex_count[shape]
        core.radius = rounding_of(shapes, world, shape)
    return core


@func
def nearest_of_face(
    shapes: Shapes, work: SoftWork, world: Int32, corners: Matrix3, core: Core, start: Vector3,
    max_distance: real,
):  # fmt: skip
    """Signed distance of a triangle from a convex core, the normal towards it, and the point of the triangle.

    `start` is a direction roughly towards the triangle. If the distance exceeds `max_distance` [m], it is a
    lower bound and the other results are meaningless.
    """
    triangle = Core()
    triangle.kind = TRIANGLES
    triangle.frame = corners
    distance, point, other, _corners = nearest_points(
        triangle, core, shapes.vertex_position, start, max_distance + core.radius, work.polytope_point,
        work.polytope_point_a, world,
    )  # fmt: skip
    normal = away_from(point - other, Vector3(0.0, 0.0, 1.0))
    if distance <= TOUCHING:
        depth, outward, deepest, _on_core = overlap(
            triangle, core, shapes.vertex_position, work.polytope_point, work.polytope_point_a,
            work.polytope_plane, work.polytope_face, work.polytope_edge, world, start, point, Int32(0),
        )  # fmt: skip
        distance = -depth
        normal = outward
        point = deepest
    return distance - core.radius, normal, point


@func
def nearest_of_face_on_surface(
    shapes: Shapes, pairs: Pairs, work: SoftWork, world: Int32, shape: Int32, corners: Matrix3,
    max_distance: real,
):  # fmt: skip
    """As `nearest_of_face`, from a mesh or height field. Its triangles only push towards their outside."""
    a = column(corners, 0)
    b = column(corners, 1)
    c = column(corners, 2)
    to_surface = wp.transpose(pairs.shape_frame[world, shape])
    origin = pairs.shape_position[world, shape]
    p = to_surface * (a - origin)
    q = to_surface * (b - origin)
    r = to_surface * (c - origin)
    around = Vector3(max_distance, max_distance, max_distance)
    region = region_of(
        shapes, world, shape, lower_corner(lower_corner(p, q), r) - around,
        upper_corner(upper_corner(p, q), r) + around,
    )  # fmt: skip
    middle = (a + b + c) / 3.0
    least = max_distance + 1.0
    best_normal = Vector3(0.0, 0.0, 1.0)
    best_point = middle
    cursor = triangle_from(shapes, region, shape, first_cursor(shapes, shape))
    while cursor >= 0:
        core = triangle_core(pairs, world, shape, triangle_corners(shapes, region, shape, cursor), 0.0)
        outward = face_normal(core.frame)
        start = (
            middle - origin - (column(core.frame, 0) + column(core.frame, 1) + column(core.frame, 2)) / 3.0
        )
        distance, normal, point = nearest_of_face(shapes, work, world, corners, core, start, max_distance)
        if distance <= max_distance and distance < least and wp.dot(normal, outward) >= 0.0:
            least = distance
            best_normal = normal
            best_point = point
        cursor = triangle_from(shapes, region, shape, following_cursor(shapes, shape, cursor))
    return least, best_normal, best_point


@func
def nearest_of_face_on_shape(
    shapes: Shapes, pairs: Pairs, work: SoftWork, world: Int32, shape: Int32, corners: Matrix3,
    max_distance: real,
):  # fmt: skip
    """As `nearest_of_face`, from a shape of any kind but an infinite plane."""
    kind = shapes.shape_kind[shape]
    a = column(corners, 0)
    middle = (a + column(corners, 1) + column(corners, 2)) / 3.0
    start = middle - pairs.shape_position[world, shape]
    distance = max_distance + 1.0
    normal = Vector3(0.0, 0.0, 1.0)
    point = middle
    if kind == SPHERE:
        center = pairs.shape_position[world, shape]
        point = on_triangle(corners, center, face_normal(corners))
        distance = wp.length(point - center) - shapes.shape_size[world, shape][0]
        normal = away_from(point - center, face_normal(corners))
    elif kind == CAPSULE or kind == BOX or kind == CYLINDER or kind == HULL:
        core = sharp_core(shapes, pairs, world, shape)
        distance, normal, point = nearest_of_face(shapes, work, world, corners, core, start, max_distance)
    else:
        distance, normal, point = nearest_of_face_on_surface(
            shapes, pairs, work, world, shape, corners, max_distance
        )
    return distance, normal, point


@func
def is_held_at_corners(work: SoftWork, world: Int32, nodes: Index4, weights: Vector3, shape: Int32) -> bool:
    """Whether touches of its nodes already keep a face outside of a shape."""
    held = 0
    for i in range(3):
        if weights[i] <= _LITTLE or has_touch(work, world, nodes[i], shape):
            held += 1
    return held == 3


@func
def is_anchored_to(soft: SoftModel, nodes: Index4, tree: Int32) -> bool:
    """Whether a node of a face is anchored to a link of a tree."""
    for anchor in range(soft.count_soft[ANCHORS]):
        if soft.anchor[anchor].tree == tree:
            node = soft.anchor[anchor].node
            if node == nodes[0] or node == nodes[1] or node == nodes[2]:
                return True
    return False


@func
def look_at_face(
    shapes: Shapes, pairs: Pairs, soft: SoftModel, state: State, work: SoftWork, world: Int32, body: Int32,
    face: Int32, shape: Int32, max_distance: real,
):  # fmt: skip
    """Store a touch of a face with a shape that is within `max_distance` [m] of it."""
    nodes = soft.face_nodes[face]
    corners = face_frame(state, world, nodes)
    distance, normal, point = nearest_of_face_on_shape(
        shapes, pairs, work, world, shape, corners, max_distance
    )
    # Solids are only pushed from outside.
    inside = soft.soft[body].tetra_count > 0 and wp.dot(normal, face_normal(corners)) > 0.0
    if distance <= max_distance and not inside:
        weights = weights_at(corners, point)
        weights = Vector3(maximum(weights[0], 0.0), maximum(weights[1], 0.0), maximum(weights[2], 0.0))
        weights = weights / (weights[0] + weights[1] + weights[2])
        if not is_held_at_corners(work, world, nodes, weights, shape):
            first = first_face_touch(work, face)
            place = keep_nearest(work, world, first, work.face_touches[world, face], distance)
            if place >= 0:
                work.face_touches[world, face] = wp.max(work.face_touches[world, face], place - first + 1)
                work.touch_shape[world, place] = shape
                work.touch_offset[world, place] = distance
                work.touch_normal[world, place] = normal
                work.touch_weights[world, place] = weights


@func
def is_near(pairs: Pairs, world: Int32, shape: Int32, lower: Vector3, upper: Vector3, reach: real) -> bool:
    """Whether a box is within `reach` [m] of the bounds of a shape along each axis."""
    for axis in range(3):
        if lower[axis] - reach > pairs.shape_upper[world, shape][axis]:
            return False
        if upper[axis] + reach < pairs.shape_lower[world, shape][axis]:
            return False
    return True


@called_func
def find_face_touches(
    settings: Settings, shapes: Shapes, model: Model, state: State, scratch: Scratch, pairs: Pairs,
    soft: SoftModel, work: SoftWork, world: Int32, body: Int32,
):  # fmt: skip
    """Find the shapes that the faces of a body may touch within a substep, after those of its nodes."""
    dt = settings.time_step
    own = model.tree[soft.soft[body].tree].first_link
    margin = soft.soft[body].margin
    first = soft.soft[body].first_face
    last = first + soft.soft[body].face_count
    for face in range(first, last):
        work.face_touches[world, face] = 0
    lower, upper = body_bounds(soft, state, world, body, dt)
    for shape in range(settings.shape_count):
        # Faces cannot reach a plane before their nodes.
        if shapes.shape_kind[shape] == PLANE:
            continue
        tree = shapes.shape_tree[shape]
        reach = margin * (1.0 + AHEAD) + shape_speed(shapes, model, state, scratch, world, tree, shape) * dt
        if not is_near(pairs, world, shape, lower, upper, reach):
            continue
        if not links_may_collide(shapes, settings, own, shapes.shape_link[shape]):
            continue
        for face in range(first, last):
            nodes = soft.face_nodes[face]
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
            max_distance = reach + fastest * dt
            low = lower_corner(lower_corner(a, b), c)
            high = upper_corner(upper_corner(a, b), c)
            if is_near(pairs, world, shape, low, high, max_distance) and not is_anchored_to(
                soft, nodes, tree
            ):
                look_at_face(shapes, pairs, soft, state, work, world, body, face, shape, max_distance)


@func
def write_face_touches(
    settings: Settings, shapes: Shapes, model: Model, state: State, scratch: Scratch, pair_rows: PairRows,
    soft: SoftModel, work: SoftWork, world: Int32, body: Int32, first_row: Int32, first_block: Int32,
):  # fmt: skip
    """Complete the touches of a body's faces, with rows over the trees that they push.

    Rows are written from `first_row` and `first_block` on. Returns the next free row and block.
    """
    row = first_row + 0
    block = first_block + 0
    own = model.tree[soft.soft[body].tree].first_link
    first = soft.soft[body].first_face
    for face in range(first, first + soft.soft[body].face_count):
        nodes = soft.face_nodes[face]
        start = first_face_touch(work, face)
        for touch in range(start, start + work.face_touches[world, face]):
            shape = work.touch_shape[world, touch]
            link = shapes.shape_link[shape]
            tree = shapes.shape_tree[shape]
            normal = work.touch_normal[world, touch]
            place = at_weights(state.node_position, world, nodes, work.touch_weights[world, touch])
            point = place - normal * work.touch_offset[world, touch]
            work.touch_point[world, touch] = point
            work.touch_friction[world, touch] = (
                shapes.link_node_friction[world, own] * shapes.shape_lateral_friction[world, shape]
            )
            work.touch_velocity[world, touch] = Vector3(0.0, 0.0, 0.0)
            work.touch_impulse[world, touch] = Vector3(0.0, 0.0, 0.0)
            work.touch_row[world, touch] = Int32(-1)
            for i in range(3):
                wake_touched(model, state, soft, work, world, body, nodes[i], touch, tree, settings.time_step)
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
