"""Supporting feature of a core in a direction: a face, edge or vertex."""

import warp as wp

from carom.kernels.maths.rotation import column
from carom.kernels.shapes.boxes import main_axis
from carom.kernels.shapes.cores import Core, farthest_of, graph_entry, toward
from carom.kernels.types import (
    Int32,
    Ints,
    Vector3,
    Vector3Rows,
    Vector4,
    Vectors3,
    Vectors4,
    func,
    real,
    shared_func,
)
from carom.layouts.codes import CAPSULE, CYLINDER, HULL, TRIANGLES

# Number of corners that approximate the rim of a cylinder.
RIM = 8
COS_45 = real(0.7071067811865476)


@func
def box_face(core: Core, direction: Vector3, polygon: Vector3Rows, world: Int32) -> Vector3:
    """Write the corners of a box's face most aligned with `direction`; returns its outward normal."""
    local = wp.transpose(core.frame) * direction
    axis = main_axis(local)
    u, v = (axis + 1) % 3, (axis + 2) % 3
    sign = toward(local[axis], 1.0)
    normal = column(core.frame, axis) * sign
    # With this sign of the second edge the corners are counter-clockwise as seen from outside.
    edge_u = column(core.frame, u) * core.size[u]
    edge_v = column(core.frame, v) * (core.size[v] * sign)
    center = core.position + normal * core.size[axis]
    polygon[world, 0] = center + edge_u + edge_v
    polygon[world, 1] = center - edge_u + edge_v
    polygon[world, 2] = center - edge_u - edge_v
    polygon[world, 3] = center + edge_u - edge_v
    return normal


@func
def arrange_box_corners(core: Core, outward: Vector3, polygon: Vector3Rows, world: Int32):
    """Write the corners of a box's face with a given normal in Bullet's order, which may be clockwise.

    The order matters: if the distribution of the load over several contacts is not unique, the first contacts
    carry more of it.
    """
    axis = main_axis(wp.transpose(core.frame) * outward)
    u, v = Int32(1) if axis == 0 else Int32(0), Int32(1) if axis == 2 else Int32(2)
    edge_u, edge_v = column(core.frame, u) * core.size[u], column(core.frame, v) * core.size[v]
    center = core.position + outward * core.size[axis]
    polygon[world, 0] = center - edge_u - edge_v
    polygon[world, 1] = center - edge_u + edge_v
    polygon[world, 2] = center + edge_u + edge_v
    polygon[world, 3] = center + edge_u - edge_v


@func
def cylinder_feature(core: Core, direction: Vector3, polygon: Vector3Rows, world: Int32):
    """Write a cylinder's cap, as a polygon with a corner at its farthest point, or a line of its side.

    Returns:
        The outward normal and the number of corners.
    """
    axis = Vector3(core.frame[0, 2], core.frame[1, 2], core.frame[2, 2])
    along = wp.dot(axis, direction)
    radial = direction - axis * along
    length = wp.length(radial)
    if length > 1.0e-9:
        radial = radial / length
    else:
        radial = Vector3(core.frame[0, 0], core.frame[1, 0], core.frame[2, 0])
    sign = toward(along, 1.0)
    if wp.abs(along) < wp.abs(length):
        rim = core.position + radial * core.size[0]
        polygon[world, 0] = rim + axis * (core.size[1] * sign)
        polygon[world, 1] = rim - axis * (core.size[1] * sign)
        return radial, Int32(2)
    normal = axis * sign
    center = core.position + normal * core.size[1]
    x = radial * core.size[0]
    y = wp.cross(normal, x)
    for corner in range(RIM):
        polygon[world, corner] = center + x
        turned = (x + y) * COS_45
        y = (y - x) * COS_45
        x = turned
    return normal, Int32(RIM)


@func
def triangle_normal(core: Core) -> Vector3:
    """Unit normal of a triangle, on the side from which its corners are counter-clockwise."""
    a = column(core.frame, 0)
    return wp.normalize(wp.cross(column(core.frame, 1) - a, column(core.frame, 2) - a))


@func
def triangle_face(core: Core, direction: Vector3, polygon: Vector3Rows, world: Int32) -> Vector3:
    """Write a triangle's corners, counter-clockwise as seen from the side to which `direction` points.

    Returns:
        The unit normal on this side.
    """
    normal = triangle_normal(core)
    polygon[world, 0] = core.position + column(core.frame, 0)
    if wp.dot(normal, direction) >= 0.0:
        polygon[world, 1] = core.position + column(core.frame, 1)
        polygon[world, 2] = core.position + column(core.frame, 2)
        return normal
    polygon[world, 1] = core.position + column(core.frame, 2)
    polygon[world, 2] = core.position + column(core.frame, 1)
    return -normal


@func
def aligned(plane: Vector4, direction: Vector3) -> real:
    """Cosine between the normal of a plane and a direction."""
    return plane[0] * direction[0] + plane[1] * direction[1] + plane[2] * direction[2]


@func
def face_of_graph(
    core: Core, first_face: Int32, vertex_position: Vectors3, face_plane: Vectors4, local: Vector3
) -> Int32:
    """The face of a hull with a graph that is most aligned with a direction, of those at its farthest vertex.

    The direction is in its frame. -1 for hulls without a graph, and if the vertex is within a joined face.
    """
    best = Int32(-1)
    if core.climbs == 1:
        vertex = farthest_of(core, vertex_position, local) - core.first_vertex
        most = real(-2.0)
        begin = graph_entry(core, vertex_position, 2 * vertex + 1)
        end = graph_entry(core, vertex_position, 2 * vertex + 2)
        for k in range(begin, end):
            face = first_face + graph_entry(core, vertex_position, k)
            along = aligned(face_plane[face], local)
            if along > most:
                most = along
                best = face
    return best


@shared_func
def supporting_face(
    core: Core,
    first_face: Int32,
    face_count: Int32,
    vertex_position: Vectors3,
    face_plane: Vectors4,
    face_first_corner: Ints,
    face_corner_count: Ints,
    corner_vertex: Ints,
    direction: Vector3,
    polygon: Vector3Rows,
    world: Int32,
):
    """Write the corners of the face (two for a line, one for a point) most aligned with `direction`.

    For boxes there is `box_face`.

    Returns:
        The face's outward normal, and the number of corners.
    """
    if core.kind == CYLINDER:
        normal, count = cylinder_feature(core, direction, polygon, world)
        return normal, count
    if core.kind == HULL:
        local = wp.transpose(core.frame) * direction
        best = face_of_graph(core, first_face, vertex_position, face_plane, local)
        if best < 0:
            best = first_face
            most = real(-2.0)
            for face in range(first_face, first_face + face_count):
                along = aligned(face_plane[face], local)
                if along > most:
                    most = along
                    best = face
        plane = face_plane[best]
        corners = face_corner_count[best]
        # If there are more corners than fit, some are left out at even intervals.
        kept = wp.min(corners, polygon.shape[1] // 2)
        first = face_first_corner[best]
        for i in range(kept):
            vertex = corner_vertex[first + (i * corners) // kept]
            polygon[world, i] = core.position + core.frame * vertex_position[vertex]
        return core.frame * Vector3(plane[0], plane[1], plane[2]), kept
    if core.kind == TRIANGLES:
        normal = triangle_face(core, direction, polygon, world)
        return normal, Int32(3)
    if core.kind == CAPSULE:
        axis = Vector3(core.frame[0, 2], core.frame[1, 2], core.frame[2, 2])
        radial = direction - axis * wp.dot(axis, direction)
        polygon[world, 0] = core.position + axis * core.size[1]
        polygon[world, 1] = core.position - axis * core.size[1]
        return wp.normalize(radial), Int32(2)
    polygon[world, 0] = core.position
    return direction, Int32(1)
