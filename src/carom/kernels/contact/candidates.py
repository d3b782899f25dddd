"""Contact candidates of one pair of shapes, and the choice of at most four of them.

A candidate is a row of `Pairs.candidate_terms`: a point on shape b (columns 0 to 2), the normal there towards
shape a (3 to 5), and the distance along the normal to shape a (6), negative where the shapes overlap. Column
7 is `FLAT` of `kernels/shapes/surfaces.py`. Of candidates that are equally good within a tolerance the first
is chosen, so that rounding seldom affects the choice.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.types import Int32, Vector3, Vector8, Vector8Rows, func, real, shared_func

# Points closer together than this count as one [m].
SAME_POINT = real(1.0e-6)
# Candidates at most this much less deep than the deepest count as equally deep [m]. So the same corners of a
# face that lies flat are chosen in every step.
AS_DEEP = real(1.0e-7)
# Relative amount by which a later candidate must be better to be preferred.
CLEARLY = real(1.0e-6)


@func
def add_candidate(
    candidates: Vector8Rows, world: Int32, count: Int32, point: Vector3, normal: Vector3, distance: real
) -> Int32:
    """Append a candidate to the first `count`, if there is room; returns the new number."""
    if count >= candidates.shape[1]:
        return count
    candidates[world, count] = Vector8(
        point[0], point[1], point[2], normal[0], normal[1], normal[2], distance, 0.0
    )
    return count + 1


@func
def candidate_point(candidates: Vector8Rows, world: Int32, row: Int32) -> Vector3:
    """Point on shape b."""
    terms = candidates[world, row]
    return Vector3(terms[0], terms[1], terms[2])


@func
def candidate_normal(candidates: Vector8Rows, world: Int32, row: Int32) -> Vector3:
    """Normal on shape b, towards shape a."""
    terms = candidates[world, row]
    return Vector3(terms[3], terms[4], terms[5])


@func
def candidate_distance(candidates: Vector8Rows, world: Int32, row: Int32) -> real:
    """Distance of the two shapes along the normal [m], negative where they overlap."""
    return candidates[world, row][6]


@func
def candidate_on_a(candidates: Vector8Rows, world: Int32, row: Int32) -> Vector3:
    """Point on shape a."""
    distance = candidate_distance(candidates, world, row)
    return candidate_point(candidates, world, row) + candidate_normal(candidates, world, row) * distance


@func
def exchange(candidates: Vector8Rows, world: Int32, i: Int32, j: Int32):
    """Swap two candidates."""
    kept = candidates[world, i]
    candidates[world, i] = candidates[world, j]
    candidates[world, j] = kept


@func
def flip_candidates(candidates: Vector8Rows, world: Int32, count: Int32):
    """Turn the candidates of shapes (a, b) into candidates of shapes (b, a)."""
    for row in range(count):
        normal = candidate_normal(candidates, world, row)
        distance = candidate_distance(candidates, world, row)
        point = candidate_on_a(candidates, world, row)
        add_candidate(candidates, world, row, point, -normal, distance)


@func
def deepest_outermost(candidates: Vector8Rows, world: Int32, count: Int32) -> Int32:
    """Row of the one among the deepest candidates that is farthest from the mean of all points."""
    deepest = candidate_distance(candidates, world, 0)
    middle = Vector3(0.0, 0.0, 0.0)
    for row in range(count):
        deepest = minimum(deepest, candidate_distance(candidates, world, row))
        middle += candidate_point(candidates, world, row) / real(count)
    best = Int32(0)
    most = real(-1.0)
    for row in range(count):
        score = wp.length_sq(candidate_point(candidates, world, row) - middle)
        if candidate_distance(candidates, world, row) <= deepest + AS_DEEP and score > most * (1.0 + CLEARLY):
            most = score
            best = Int32(row)
    return best


@shared_func
def keep_four(candidates: Vector8Rows, world: Int32, count: Int32) -> Int32:
    """Choose at most four candidates that span the contact and put them first; returns their number.

    The deepest (of several equally deep ones the outermost), the one farthest from it, the one farthest from
    the line through these two, and the one farthest outside the triangle of these three.
    """
    if count <= 1:
        return count
    best = deepest_outermost(candidates, world, count)
    exchange(candidates, world, 0, best)
    a = candidate_point(candidates, world, 0)

    best = Int32(-1)
    most = SAME_POINT * SAME_POINT
    for row in range(1, count):
        score = wp.length_sq(candidate_point(candidates, world, row) - a)
        if score > most * (1.0 + CLEARLY):
            most = score
            best = row
    if best < 0:
        return 1
    exchange(candidates, world, 1, best)
    b = candidate_point(candidates, world, 1)

    base = most
    best = Int32(-1)
    most = base * SAME_POINT * SAME_POINT
    for row in range(2, count):
        score = wp.length_sq(wp.cross(b - a, candidate_point(candidates, world, row) - a))
        if score > most * (1.0 + CLEARLY):
            most = score
            best = row
    if best < 0:
        return 2
    exchange(candidates, world, 2, best)
    c = candidate_point(candidates, world, 2)

    normal = wp.cross(b - a, c - a)
    best = Int32(-1)
    most = SAME_POINT * SAME_POINT * wp.sqrt(base) * wp.length(normal)
    for row in range(3, count):
        p = candidate_point(candidates, world, row)
        outside = maximum(
            wp.dot(wp.cross(p - a, b - a), normal),
            maximum(wp.dot(wp.cross(p - b, c - b), normal), wp.dot(wp.cross(p - c, a - c), normal)),
        )
        if outside > most * (1.0 + CLEARLY):
            most = outside
            best = row
    if best < 0:
        return 3
    exchange(candidates, world, 3, best)
    return 4
