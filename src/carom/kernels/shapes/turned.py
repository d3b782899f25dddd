"""More contact points of cylinders and capsules, as in MuJoCo: those of the same shapes turned a little.

A cylinder that rests with a face or a side touches along lines and rims, of which only one point is nearest.
If the shapes are turned against each other about the contact, other points are.
"""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.rotation import axis_rotation, rotation_matrix
from carom.kernels.shapes.convex import nearest_or_deepest
from carom.kernels.shapes.cores import Core, half_extents
from carom.kernels.structs import Pairs, Shapes
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import CAPSULE, CYLINDER

# By how much each of two shapes is turned, against the other [rad].
ANGLE = real(1.0e-3)
# Points nearer to each other are one, relative to the radius of the smaller shape.
SAME = real(1.0e-3)


@func
def outer_radius(core: Core) -> real:
    """Radius of a ball around the middle of a shape, as MuJoCo has it [m]."""
    if core.kind == CAPSULE:
        return core.radius + core.size[1]
    extents = half_extents(core)
    # That of a cylinder is less than that of the box around it.
    if core.kind == CYLINDER:
        extents[1] = real(0.0)
    return wp.length(extents)


@func
def turned_about(core: Core, point: Vector3, turn: Matrix3) -> Core:
    """A shape turned about a point."""
    other = core
    other.position = point + turn * (core.position - point)
    other.frame = turn * core.frame
    return other


@func
def first_tangent(normal: Vector3) -> Vector3:
    """The first of the directions across a normal in which MuJoCo turns shapes."""
    axis = Vector3(0.0, 1.0, 0.0)
    if wp.abs(normal[1]) >= 0.5:
        axis = Vector3(0.0, 0.0, 1.0)
    return wp.normalize(axis - normal * wp.dot(normal, axis))


@func
def collide_turned(
    shapes: Shapes,
    pairs: Pairs,
    world: Int32,
    core_a: Core,
    core_b: Core,
    max_distance: real,
    start: Vector3,
    last_normal: Vector3,
) -> Int32:
    """Write the nearest or deepest candidate of two cores, and up to four of the same cores turned.

    The others are as deep as the first. `start` and `last_normal` are those of `nearest_or_deepest`. Returns
    the number of candidates.
    """
    rounding = core_a.radius + core_b.radius
    same = SAME * wp.min(outer_radius(core_a), outer_radius(core_b))
    count = Int32(0)
    first_distance = real(0.0)
    none = Vector3(0.0, 0.0, 0.0)
    middle = core_a.position + none
    axis = start + none
    across = start + none
    for run in range(5):
        if run == 0 or count > 0:
            turn = wp.identity(n=3, dtype=real)
            if run > 0:
                side = across + none
                if run > 2:
                    side = wp.cross(axis, across)
                turn = rotation_matrix(axis_rotation(side, ANGLE * (1.0 - 2.0 * real(run % 2))))
            one = turned_about(core_a, middle, turn)
            other = turned_about(core_b, middle, wp.transpose(turn))
            known = wp.where(run == 0, last_normal, none)
            core_distance, normal, _point_a, point_b = nearest_or_deepest(
                shapes, pairs, world, one, other, max_distance + rounding, start, known
            )
            distance = core_distance - rounding
            # Beyond the second the points are meaningless, and rounding may hide that from the first.
            if distance <= max_distance and core_distance <= max_distance + rounding:
                place = point_b + normal * (other.radius + 0.5 * distance)
                if run == 0:
                    first_distance = distance
                    middle = place
                    axis = normal
                    across = first_tangent(normal)
                is_new = Int32(1)
                for row in range(count):
                    known_place = pairs.candidate[world, row].point
                    known_place += pairs.candidate[world, row].normal * (0.5 * first_distance)
                    if wp.length(place - known_place) <= same:
                        is_new = Int32(0)
                if is_new == 1:
                    count = add_candidate(
                        pairs.candidate, world, count, place - normal * (0.5 * first_distance), normal,
                        first_distance,
                    )  # fmt: skip
    return count
