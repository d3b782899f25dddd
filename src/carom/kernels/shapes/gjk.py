"""Nearest points of two cores, by the algorithm of Gilbert, Johnson and Keerthi (GJK).

The algorithm searches the Minkowski difference of the cores, the set of all differences a - b of their
points, for the point nearest to the origin. A simplex of at most four differences moves towards this point.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum, within_bounds
from carom.kernels.shapes.cores import Core, support
from carom.kernels.types import (
    Int32,
    Matrix43,
    Vector3,
    Vector3Rows,
    Vector4,
    Vectors3,
    func,
    real,
    shared_func,
)

MAX_STEPS = 64
# Cores nearer than this count as overlapping [m].
TOUCHING = real(1.0e-10)
# Absolute tolerance of the distance [m].
PRECISION = real(1.0e-13)
# Relative tolerance of the distance; the larger one of the two is used.
RELATIVE_PRECISION = real(1.0e-14)
# Sine of the angle between a face of a tetrahedron and an edge to the opposite corner, up to which the
# tetrahedron is flat.
FLAT = real(1.0e-14)


@func
def corner(simplex: Matrix43, i: Int32) -> Vector3:
    """Corner `i` of a simplex."""
    return Vector3(simplex[i, 0], simplex[i, 1], simplex[i, 2])


@func
def weighted(simplex: Matrix43, weights: Vector4) -> Vector3:
    """Weighted sum of corners."""
    return (
        corner(simplex, 0) * weights[0]
        + corner(simplex, 1) * weights[1]
        + corner(simplex, 2) * weights[2]
        + corner(simplex, 3) * weights[3]
    )


@func
def segment_weights(a: Vector3, b: Vector3):
    """Weights of a and b in the point of their segment nearest to the origin."""
    edge = b - a
    length_sq = wp.length_sq(edge)
    share = within_bounds(-wp.dot(a, edge) / length_sq, 0.0, 1.0) if length_sq > 0.0 else 0.0
    return 1.0 - share, share


@shared_func
def triangle_weights(a: Vector3, b: Vector3, c: Vector3) -> Vector3:
    """Weights of the corners in the point of a triangle nearest to the origin."""
    normal = wp.cross(b - a, c - a)
    area = wp.length_sq(normal)
    # Areas of the triangles between each side and the projection of the origin, with a common factor.
    of_a = wp.dot(normal, wp.cross(b, c))
    of_b = wp.dot(normal, wp.cross(c, a))
    of_c = wp.dot(normal, wp.cross(a, b))
    if area > 0.0 and of_a >= 0.0 and of_b >= 0.0 and of_c >= 0.0:
        total = of_a + of_b + of_c
        return Vector3(of_a / total, of_b / total, of_c / total)
    a1, b1 = segment_weights(a, b)
    b2, c2 = segment_weights(b, c)
    c3, a3 = segment_weights(c, a)
    on_ab = wp.length_sq(a * a1 + b * b1)
    on_bc = wp.length_sq(b * b2 + c * c2)
    on_ca = wp.length_sq(c * c3 + a * a3)
    if on_ab <= on_bc and on_ab <= on_ca:
        return Vector3(a1, b1, 0.0)
    return Vector3(0.0, b2, c2) if on_bc <= on_ca else Vector3(a3, 0.0, c3)


@func
def face_hides_origin(a: Vector3, b: Vector3, c: Vector3, opposite: Vector3) -> bool:
    """Whether the origin and the fourth corner are on different sides of a face of a tetrahedron."""
    normal = wp.cross(b - a, c - a)
    inside = wp.dot(normal, opposite - a)
    size_sq = wp.length_sq(normal) * wp.length_sq(opposite - a)
    # A flat tetrahedron has no inside.
    return inside * inside <= FLAT * FLAT * size_sq or wp.dot(normal, -a) * inside < 0.0


@func
def tetrahedron_weights(simplex: Matrix43) -> Vector4:
    """Weights of the corners in a tetrahedron's nearest point; all positive if it contains the origin."""
    result = Vector4(0.25, 0.25, 0.25, 0.25)
    least = real(-1.0)
    face = Int32(0)
    while face < 4:
        i = (face + 1) % 4
        j = (face + 2) % 4
        k = (face + 3) % 4
        a = corner(simplex, i)
        b = corner(simplex, j)
        c = corner(simplex, k)
        if face_hides_origin(a, b, c, corner(simplex, face)):
            weights = triangle_weights(a, b, c)
            distance = wp.length_sq(a * weights[0] + b * weights[1] + c * weights[2])
            if least < 0.0 or distance < least:
                least = distance
                result = Vector4(0.0, 0.0, 0.0, 0.0)
                result[i] = weights[0]
                result[j] = weights[1]
                result[k] = weights[2]
        face += 1
    return result


@func
def nearest_weights(simplex: Matrix43, count: Int32) -> Vector4:
    """Weights of the first `count` corners in the point of their hull nearest to the origin."""
    if count == 4:
        return tetrahedron_weights(simplex)
    if count == 3:
        weights = triangle_weights(corner(simplex, 0), corner(simplex, 1), corner(simplex, 2))
        return Vector4(weights[0], weights[1], weights[2], 0.0)
    if count == 2:
        a, b = segment_weights(corner(simplex, 0), corner(simplex, 1))
        return Vector4(a, b, 0.0, 0.0)
    return Vector4(1.0, 0.0, 0.0, 0.0)


@shared_func
def nearest_points(
    core_a: Core,
    core_b: Core,
    vertex_position: Vectors3,
    start: Vector3,
    max_distance: real,
    tetrahedron: Vector3Rows,
    tetrahedron_a: Vector3Rows,
    world: Int32,
):
    """Nearest points of two cores.

    `start` is an approximate direction from b to a. The search ends as soon as the distance is known to
    exceed `max_distance` [m].

    Returns:
        The distance [m], the nearest points on a and on b, and a number of corners. If the cores overlap, the
        distance is 0 and both points are the same point of a. Then `tetrahedron` gets four corners of the
        Minkowski difference around the origin, and `tetrahedron_a` their points on a, and there are 4; else
        0. If the distance exceeds `max_distance`, it is a lower bound and the points are meaningless.
    """
    differences = Matrix43()
    points = Matrix43()
    direction = Vector3(1.0, 0.0, 0.0) if wp.length_sq(start) == 0.0 else start
    count = Int32(0)
    weights = Vector4(1.0, 0.0, 0.0, 0.0)
    v = direction
    least = real(-1.0)
    point_a = core_a.position
    steps = Int32(0)
    searching = Int32(1)
    while searching == 1 and steps < MAX_STEPS:
        steps += 1
        on_a = support(core_a, vertex_position, -v)
        on_b = support(core_b, vertex_position, v)
        w = on_a - on_b
        length = wp.length(v)
        bound = wp.dot(v, w) / length
        if bound > max_distance:
            return bound, core_a.position, core_b.position, Int32(0)
        if count > 0:
            if length - bound <= maximum(PRECISION, RELATIVE_PRECISION * (length + wp.length(w))):
                searching = Int32(0)
        if searching == 1:
            for axis in range(3):
                differences[count, axis] = w[axis]
                points[count, axis] = on_a[axis]
            count += 1
            weights = nearest_weights(differences, count)
            if count == 4 and wp.min(weights) > 0.0:
                for row in range(4):
                    tetrahedron[world, row] = corner(differences, row)
                    tetrahedron_a[world, row] = corner(points, row)
                return real(0.0), on_a, on_a, Int32(4)
            nearest = weighted(differences, weights)
            distance = wp.length(nearest)
            if least >= 0.0 and distance >= least:
                # Further progress would be rounding error only: the previous simplex is the result.
                searching = Int32(0)
            else:
                least = distance
                v = nearest
                point_a = weighted(points, weights)
                kept = Int32(0)
                for i in range(4):
                    if i < count and weights[i] > 0.0:
                        for axis in range(3):
                            differences[kept, axis] = differences[i, axis]
                            points[kept, axis] = points[i, axis]
                        kept += 1
                if distance <= TOUCHING:
                    return real(0.0), point_a, point_a, Int32(0)
                count = kept
    return least, point_a, point_a - v, Int32(0)
