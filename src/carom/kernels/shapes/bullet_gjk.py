"""Nearest points of two cores where Bullet finds them.

If a face or an edge of one core is parallel to one of the other, many pairs of points are equally near.
Bullet's GJK ends at one that depends on its way: on its first direction, on its rules for segments, triangles
and tetrahedra, and on the order of the two cores. A puck that lands flat tips over this point. If the faces
are nearly parallel, or shapes small or round, Bullet stops early, because a tetrahedron is too thin. So this
is the same search, with the same rules in the same order. The one in `gjk.py` is made for accuracy, and takes
over where cores overlap.
"""

import warp as wp

from carom.kernels.maths.min_max import minimum
from carom.kernels.shapes.cores import Core, local_support
from carom.kernels.shapes.gjk import corner, weighted
from carom.kernels.types import Index3, Int32, Matrix43, Vector3, Vector4, Vectors3, func, real, shared_func

MAX_STEPS = 1000
# Bullet's tolerances: of the squared distance, and of its decrease in a step, both as a fraction; the squared
# distance of equal points and that of cores that touch [m^2]; six times the volume of a flat tetrahedron
# [m^3].
PRECISION = real(1.0e-12)
ROUNDING = real(2.220446049250313e-16)
SAME_POINT = real(9.999999960041972e-13)
TOUCHING = real(1.0e-12)
NO_VOLUME = real(1.0e-8)
# Bits of the corners of a triangle, and what stands for them where a tetrahedron is flat.
ALL_THREE, FLAT = wp.constant(7), wp.constant(16)
# Outcomes of a search.
FAILED, FOUND, TOO_FAR = 0, 1, 2


@wp.struct
class Nearest:
    """Nearest point of a simplex: weights of its corners, and the bits of those it depends on."""

    weights: Vector4
    used: Int32
    point: Vector3


@func
def at_corner(a: Vector3, index: Int32) -> Nearest:
    """A corner as the nearest point."""
    result = Nearest()
    result.weights[index] = 1.0
    result.used = 1 << index
    result.point = a
    return result


@func
def on_edge(a: Vector3, b: Vector3, share: real, i: Int32, j: Int32) -> Nearest:
    """The point at `share` of the way from corner i at a to corner j at b."""
    result = Nearest()
    result.weights[i] = 1.0 - share
    result.weights[j] = share
    result.used = (1 << i) | (1 << j)
    result.point = a + (b - a) * share
    return result


@func
def nearest_on_segment(a: Vector3, b: Vector3) -> Nearest:
    """Point of a segment nearest to the origin."""
    along = wp.dot(b - a, -a)
    if along <= 0.0:
        return at_corner(a, 0)
    length_sq = wp.length_sq(b - a)
    return on_edge(a, b, along / length_sq, 0, 1) if along < length_sq else at_corner(b, 1)


@func
def nearest_on_triangle(a: Vector3, b: Vector3, c: Vector3) -> Nearest:
    """Point of a triangle nearest to the origin."""
    ab = b - a
    ac = c - a
    d1 = wp.dot(ab, -a)
    d2 = wp.dot(ac, -a)
    if d1 <= 0.0 and d2 <= 0.0:
        return at_corner(a, 0)
    d3 = wp.dot(ab, -b)
    d4 = wp.dot(ac, -b)
    if d3 >= 0.0 and d4 <= d3:
        return at_corner(b, 1)
    of_c = d1 * d4 - d3 * d2
    if of_c <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return on_edge(a, b, d1 / (d1 - d3), 0, 1)
    d5 = wp.dot(ab, -c)
    d6 = wp.dot(ac, -c)
    if d6 >= 0.0 and d5 <= d6:
        return at_corner(c, 2)
    of_b = d5 * d2 - d1 * d6
    if of_b <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return on_edge(a, c, d2 / (d2 - d6), 0, 2)
    of_a = d3 * d6 - d5 * d4
    if of_a <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        return on_edge(b, c, (d4 - d3) / ((d4 - d3) + (d5 - d6)), 1, 2)
    scale = 1.0 / (of_a + of_b + of_c)
    v = of_b * scale
    w = of_c * scale
    result = Nearest()
    result.weights = Vector4(1.0 - v - w, v, w, 0.0)
    result.used = ALL_THREE
    result.point = a + ab * v + ac * w
    return result


@func
def face_of_tetrahedron(face: Int32) -> Index3:
    """Corners of a face of a tetrahedron, in the order in which Bullet has them."""
    if face == 0:
        return Index3(0, 1, 2)
    if face == 1:
        return Index3(0, 2, 3)
    return Index3(0, 3, 1) if face == 2 else Index3(1, 3, 2)


@func
def nearest_on_tetrahedron(simplex: Matrix43) -> Nearest:
    """Point of a tetrahedron's surface nearest to the origin.

    It depends on no corner if the tetrahedron contains the origin; `used` is `FLAT` if it is flat.
    """
    result = Nearest()
    least = real(-1.0)
    for face in range(4):
        corners = face_of_tetrahedron(face)
        a = corner(simplex, corners[0])
        b = corner(simplex, corners[1])
        c = corner(simplex, corners[2])
        normal = wp.cross(b - a, c - a)
        volume = wp.dot(corner(simplex, 6 - corners[0] - corners[1] - corners[2]) - a, normal)
        if wp.abs(volume) < NO_VOLUME:
            flat = Nearest()
            flat.used = FLAT
            return flat
        if wp.dot(-a, normal) * volume < 0.0:
            on_face = nearest_on_triangle(a, b, c)
            distance = wp.length_sq(on_face.point)
            if least < 0.0 or distance < least:
                least = distance
                result = Nearest()
                result.point = on_face.point
                for i in range(3):
                    result.weights[corners[i]] = on_face.weights[i]
                    result.used = result.used | (((on_face.used >> i) & 1) << corners[i])
    return result


@func
def nearest_on(simplex: Matrix43, count: Int32) -> Nearest:
    """Point nearest to the origin of the simplex of the first `count` corners."""
    if count == 1:
        return at_corner(corner(simplex, 0), 0)
    if count == 2:
        return nearest_on_segment(corner(simplex, 0), corner(simplex, 1))
    if count == 3:
        return nearest_on_triangle(corner(simplex, 0), corner(simplex, 1), corner(simplex, 2))
    return nearest_on_tetrahedron(simplex)


@func
def away_from(points: Matrix43, count: Int32, point: Vector3) -> real:
    """Squared distance of `point` from the nearest of the first `count` points."""
    least = real(1.0e30)
    for i in range(count):
        least = minimum(least, wp.length_sq(corner(points, i) - point))
    return least


@func
def farthest(core: Core, vertex_position: Vectors3, direction: Vector3, middle: Vector3) -> Vector3:
    """Farthest point of a core along a direction, relative to `middle`."""
    local = local_support(core, vertex_position, wp.transpose(core.frame) * direction)
    return core.frame * local + (core.position - middle)


@shared_func
def nearest_as_in_bullet(core_a: Core, core_b: Core, vertex_position: Vectors3, max_distance: real):
    """Nearest points of two cores; nothing is found if they overlap or touch.

    Returns:
        `FOUND`, `FAILED`, or `TOO_FAR` if the distance exceeds `max_distance` [m]; the distance [m], the
        normal on b towards a, and the nearest point on b.
    """
    middle = (core_a.position + core_b.position) * 0.5
    differences = Matrix43()
    on_a = Matrix43()
    on_b = Matrix43()
    count = Int32(0)
    axis = Vector3(0.0, 1.0, 0.0)
    last = Vector3(1.0e30, 1.0e30, 1.0e30)
    distance_sq = real(1.0e30)
    point_a = Vector3(0.0, 0.0, 0.0)
    point_b = Vector3(0.0, 0.0, 0.0)
    steps = Int32(0)
    while steps < MAX_STEPS and count < 4:
        steps += 1
        new_a = farthest(core_a, vertex_position, -axis, middle)
        new_b = farthest(core_b, vertex_position, axis, middle)
        new = new_a - new_b
        bound = wp.dot(axis, new)
        if bound > 0.0 and bound * bound > distance_sq * max_distance * max_distance:
            return Int32(TOO_FAR), max_distance, axis, point_b
        if new == last or away_from(differences, count, new) <= SAME_POINT:
            break
        if distance_sq - bound <= distance_sq * PRECISION:
            break
        last = new
        for i in range(3):
            differences[count, i] = new[i]
            on_a[count, i] = new_a[i]
            on_b[count, i] = new_b[i]
        count += 1
        found = nearest_on(differences, count)
        if found.used == 0:
            return Int32(FAILED), max_distance, axis, point_b
        if found.used == FLAT:
            # The nearest point so far is Bullet's result, though it may not be the nearest of all.
            break
        if count == 2:
            share = found.weights[1]
            point_a = corner(on_a, 0) + (corner(on_a, 1) - corner(on_a, 0)) * share
            point_b = corner(on_b, 0) + (corner(on_b, 1) - corner(on_b, 0)) * share
        else:
            point_a = weighted(on_a, found.weights)
            point_b = weighted(on_b, found.weights)
        before_sq = distance_sq
        difference = point_a - point_b
        if wp.min(found.weights) < 0.0:
            break
        distance_sq = wp.length_sq(difference)
        if distance_sq < TOUCHING:
            return Int32(FAILED), max_distance, axis, point_b
        if before_sq - distance_sq <= ROUNDING * before_sq:
            break
        axis = difference
        unused = Int32(3)
        while unused >= 0:
            if unused < count and ((found.used >> unused) & 1) == 0:
                count -= 1
                for i in range(3):
                    differences[unused, i] = differences[count, i]
                    on_a[unused, i] = on_a[count, i]
                    on_b[unused, i] = on_b[count, i]
            unused -= 1
    length = wp.length(axis)
    outcome = Int32(FOUND if steps < MAX_STEPS else FAILED)
    return outcome, length, axis / length, middle + point_b
