"""Contact candidates of convex shapes on infinite planes."""

import math

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.cores import Core, support
from carom.kernels.structs import CandidateRows
from carom.kernels.types import Int32, Vector3, Vector3Rows, Vectors3, func, real, shared_func
from carom.layouts.codes import BOX, HULL

HALF_ROOT_OF_THREE = real(0.5 * math.sqrt(3.0))
# Of the distance of a point from itself, computed twice [m²].
ROUNDING = real(1e-20)
# The sine of the angle of an upright cylinder's axis with the normal is less, as in MuJoCo.
UPRIGHT = real(1e-15)


@func
def with_sharp_edges(core: Core) -> Core:
    """Core of a box with sharp edges instead of rounding; other cores are returned unchanged."""
    sharp = core
    if core.kind == BOX:
        sharp.size = core.size + Vector3(core.radius, core.radius, core.radius)
        sharp.radius = real(0.0)
    return sharp


@func
def add_on_plane(
    candidates: CandidateRows,
    world: Int32,
    count: Int32,
    point: Vector3,
    radius: real,
    origin: Vector3,
    normal: Vector3,
    max_distance: real,
) -> Int32:
    """Add the candidate of a sphere on a plane, if they are near enough; returns the new number."""
    height = wp.dot(point - origin, normal)
    if height - radius > max_distance:
        return count
    return add_candidate(candidates, world, count, point - normal * height, normal, height - radius)


@func
def collide_plane_deepest(
    core: Core,
    vertex_position: Vectors3,
    origin: Vector3,
    normal: Vector3,
    max_distance: real,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """As `collide_plane`, but with the deepest point only."""
    deepest = support(core, vertex_position, -normal)
    return add_on_plane(candidates, world, 0, deepest, core.radius, origin, normal, max_distance)


@shared_func
def collide_cylinder_on_plane(
    core: Core,
    origin: Vector3,
    normal: Vector3,
    max_distance: real,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """Write the candidates of a cylinder on a plane as MuJoCo has them; returns their number.

    They are the deepest point of the rim that is turned to the plane, that of the other rim on the same side,
    and on the first rim two more, so that the three on it are at equal distances. An upright cylinder has the
    first one on its x axis.
    """
    radius = core.size[0] + core.radius
    axis = column(core.frame, 2)
    if wp.dot(axis, normal) > 0.0:
        axis = -axis
    along = wp.dot(axis, normal)
    down = axis * along - normal
    if wp.length(down) < UPRIGHT:
        down = column(core.frame, 0)
    out = wp.normalize(down) * radius
    half = axis * (core.size[1] + core.radius)
    aside = wp.normalize(wp.cross(out, axis)) * (radius * HALF_ROOT_OF_THREE)
    count = Int32(0)
    near = core.position + half
    none = real(0.0)
    if wp.dot(near + out - origin, normal) <= max_distance:
        count = add_on_plane(candidates, world, count, near + out, none, origin, normal, max_distance)
        far = core.position - half + out
        count = add_on_plane(candidates, world, count, far, none, origin, normal, max_distance)
        for side in range(2):
            point = near - 0.5 * out + aside * (1.0 - 2.0 * real(side))
            count = add_on_plane(candidates, world, count, point, none, origin, normal, max_distance)
    return count


@shared_func
def collide_plane(
    core: Core,
    polygon: Vector3Rows,
    corners: Int32,
    vertex_position: Vectors3,
    origin: Vector3,
    normal: Vector3,
    max_distance: real,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """Write the candidates of shape a, a core, on shape b, a plane; returns their number.

    Boxes have sharp edges. `polygon` has the corners of the core's face towards the plane. Hulls have their
    deepest vertex, and these corners or, if there are none, all vertices. The plane is given by a point and
    its unit normal.
    """
    count = Int32(0)
    if core.kind != HULL:
        for i in range(corners):
            count = add_on_plane(
                candidates, world, count, polygon[world, i], core.radius, origin, normal, max_distance
            )
        return count
    # The deepest point comes first, so that it is included even if not all points fit.
    deepest = support(core, vertex_position, -normal)
    count = add_on_plane(candidates, world, count, deepest, core.radius, origin, normal, max_distance)
    if count > 0 and corners > 0:
        for i in range(corners):
            if wp.length_sq(polygon[world, i] - deepest) > ROUNDING:
                count = add_on_plane(
                    candidates, world, count, polygon[world, i], core.radius, origin, normal, max_distance
                )
        return count
    if count > 0:
        for vertex in range(core.first_vertex, core.first_vertex + core.vertex_count):
            point = core.position + core.frame * vertex_position[vertex]
            count = add_on_plane(candidates, world, count, point, core.radius, origin, normal, max_distance)
    return count
