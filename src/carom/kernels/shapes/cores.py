"""Convex shapes in the narrow phase: a core, and a radius by which it is rounded.

The core follows from Bullet's collision margin. The core of a sphere is a point, and that of a capsule is a
segment. The margin of a box or cylinder lies inside the shape: the core is smaller by the margin, and edges
are round. The margin of a hull or triangle lies outside. Boxes have sharp edges only against other boxes and
planes.
"""

import warp as wp

from carom.kernels.maths.min_max import least_entry, minimum
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, Vectors3, func, real
from carom.layouts.codes import (
    BOX,
    CAPSULE,
    CYLINDER,
    ELLIPSOID,
    ELLIPSOID_FACETS,
    FIRST_LOOKED_AT,
    HULL,
    SPHERE,
    TRIANGLES,
    WITH_GRAPH,
)


@wp.struct
class Core:
    """Core of a convex shape, the shape without its rounding.

    The kind is `SPHERE` for a point, `CAPSULE` for a segment, `BOX`, `CYLINDER`, `HULL` and `ELLIPSOID`, and
    `TRIANGLES` for one triangle, whose corners are the columns of `frame`, relative to `position`; or for the
    prism between it and the same triangle moved by `size`, in world axes.
    """

    kind: Int32
    size: Vector3  # as `Shapes.shape_size`, less the rounding
    radius: real
    position: Vector3
    frame: Matrix3
    first_vertex: Int32
    vertex_count: Int32
    climbs: Int32  # 1: a graph is after its vertices


@func
def core_of(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32) -> Core:
    """Core of a convex shape."""
    core = Core()
    core.kind = shapes.shape_kind[shape]
    core.size = shapes.shape_size[world, shape]
    core.position = pairs.shape_position[world, shape]
    core.frame = pairs.shape_frame[world, shape]
    margin = shapes.shape_margin[world, shape]
    if core.kind == SPHERE or core.kind == CAPSULE:
        core.radius = core.size[0]
    elif core.kind == BOX:
        core.radius = minimum(margin, least_entry(core.size))
        core.size = core.size - Vector3(core.radius, core.radius, core.radius)
    elif core.kind == CYLINDER:
        core.radius = minimum(margin, minimum(core.size[0], core.size[1]))
        core.size = core.size - Vector3(core.radius, core.radius, 0.0)
    else:
        core.radius = margin
        if core.kind == HULL:
            if shapes.shape_columns[shape] == ELLIPSOID_FACETS:
                core.kind = Int32(ELLIPSOID)
            elif shapes.shape_columns[shape] == WITH_GRAPH:
                core.climbs = Int32(1)
        core.first_vertex = shapes.shape_first_vertex[shape]
        core.vertex_count = shapes.shape_vertex_count[shape]
    return core


@func
def sharpened(core: Core) -> Core:
    """Core of a box or cylinder with sharp edges instead of rounding; other cores are returned unchanged."""
    sharp = core
    radius = core.radius
    if core.kind == BOX:
        sharp.size = core.size + Vector3(radius, radius, radius)
        sharp.radius = real(0.0)
    elif core.kind == CYLINDER:
        sharp.size = core.size + Vector3(radius, radius, 0.0)
        sharp.radius = real(0.0)
    return sharp


@func
def segment_half(core: Core) -> Vector3:
    """Vector from the middle of a capsule's segment to one end; zero for a sphere."""
    return core.frame * Vector3(0.0, 0.0, core.size[1]) if core.kind == CAPSULE else Vector3(0.0, 0.0, 0.0)


@func
def toward(value: real, size: real) -> real:
    """`size` with the sign of `value`."""
    if value < 0.0:
        return -size
    return size


@wp.func_native("""
    const auto* points = &wp::index(vertices, first);
    // Four searches beside each other; of vertices equally far the first one is found.
    wp::float64 most[4];
    int best[4];
    for (int k = 0; k < 4; ++k) {
        best[k] = k < count ? k : 0;
        most[k] = wp::dot(points[best[k]], direction);
    }
    int i = 4;
    for (; i + 4 <= count; i += 4)
        for (int k = 0; k < 4; ++k) {
            const auto along = wp::dot(points[i + k], direction);
            if (along > most[k]) {
                most[k] = along;
                best[k] = i + k;
            }
        }
    for (; i < count; ++i) {
        const auto along = wp::dot(points[i], direction);
        if (along > most[0]) {
            most[0] = along;
            best[0] = i;
        }
    }
    int found = 0;
    for (int k = 1; k < 4; ++k)
        if (most[k] > most[found] || (most[k] == most[found] && best[k] < best[found]))
            found = k;
    return first + best[found];
""")
def farthest_vertex(vertices: Vectors3, first: Int32, count: Int32, direction: Vector3) -> Int32:
    """Row of the vertex that is farthest along a direction, of `count` ones from `first` on."""
    ...


@wp.func_native("""
    const auto* points = &wp::index(vertices, first);
    const auto* table = reinterpret_cast<const wp::float64*>(points + count);
    int best = start;
    auto most = wp::dot(points[best], direction);
    for (int from = -1; from != best;) {
        from = best;
        const auto end = static_cast<wp::int32>(table[2 * from + 1]);
        for (auto k = static_cast<wp::int32>(table[2 * from]); k < end; ++k) {
            const auto beside = static_cast<wp::int32>(table[k]);
            const auto along = wp::dot(points[beside], direction);
            if (along > most) {
                most = along;
                best = beside;
            }
        }
    }
    return first + best;
""")
def climbed_vertex(vertices: Vectors3, first: Int32, count: Int32, direction: Vector3, start: Int32) -> Int32:
    """As `farthest_vertex` of a hull with a graph: from neighbour to neighbour, from number `start` on."""
    ...


@func
def farthest_of(core: Core, vertices: Vectors3, direction: Vector3) -> Int32:
    """Row of the vertex of a hull that is farthest along a direction in its frame."""
    if core.climbs == 0:
        return farthest_vertex(vertices, core.first_vertex, core.vertex_count, direction)
    first = core.first_vertex
    start = farthest_vertex(vertices, first, FIRST_LOOKED_AT, direction) - first
    return climbed_vertex(vertices, first, core.vertex_count, direction, start)


@func
def graph_entry(core: Core, vertices: Vectors3, at: Int32) -> Int32:
    """The number at a place of the graph after the vertices of a hull."""
    return Int32(vertices[core.first_vertex + core.vertex_count + at // 3][at % 3])


@func
def half_extents(core: Core) -> Vector3:
    """Half extents of the smallest box around a convex shape, in its axes."""
    around = Vector3(core.radius, core.radius, core.radius)
    if core.kind == BOX or core.kind == HULL or core.kind == ELLIPSOID:
        around += core.size
    elif core.kind == CYLINDER:
        around += Vector3(core.size[0], core.size[0], core.size[1])
    elif core.kind == CAPSULE:
        around += Vector3(0.0, 0.0, core.size[1])
    return around


@func
def local_support(core: Core, vertex_position: Vectors3, direction: Vector3) -> Vector3:
    """Support mapping: farthest point of a core along a direction, both in the frame of the shape."""
    size = core.size
    if core.kind == BOX:
        return Vector3(
            toward(direction[0], size[0]), toward(direction[1], size[1]), toward(direction[2], size[2])
        )
    if core.kind == HULL:
        return vertex_position[farthest_of(core, vertex_position, direction)]
    if core.kind == CYLINDER:
        radial = wp.sqrt(direction[0] * direction[0] + direction[1] * direction[1])
        if radial == 0.0:
            return Vector3(size[0], 0.0, toward(direction[2], size[1]))
        scale = size[0] / radial
        return Vector3(direction[0] * scale, direction[1] * scale, toward(direction[2], size[1]))
    if core.kind == CAPSULE:
        return Vector3(0.0, 0.0, toward(direction[2], size[1]))
    if core.kind == ELLIPSOID:
        along = wp.cw_mul(size, direction)
        length = wp.length(along)
        return wp.cw_mul(size, along) / length if length > 0.0 else Vector3(size[0], 0.0, 0.0)
    if core.kind == TRIANGLES:
        # `frame` has the corners as columns, so `direction` holds the corners' heights along the direction.
        if direction[0] >= direction[1] and direction[0] >= direction[2]:
            return Vector3(1.0, 0.0, 0.0)
        return Vector3(0.0, 1.0, 0.0) if direction[1] >= direction[2] else Vector3(0.0, 0.0, 1.0)
    if core.kind == ELLIPSOID:
        along = wp.cw_mul(size, direction)
        length = wp.length(along)
        return wp.cw_mul(size, along) / length if length > 0.0 else Vector3(0.0, 0.0, size[2])
    return Vector3(0.0, 0.0, 0.0)


@func
def support(core: Core, vertex_position: Vectors3, direction: Vector3) -> Vector3:
    """Support mapping: farthest point of a core along a direction, both in world axes."""
    local = wp.transpose(core.frame) * direction
    farthest = core.position + core.frame * local_support(core, vertex_position, local)
    if core.kind == TRIANGLES and wp.dot(core.size, direction) > 0.0:
        farthest += core.size
    return farthest
