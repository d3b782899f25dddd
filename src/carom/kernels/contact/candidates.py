"""Contact candidates of one pair of shapes, and the choice of at most four of them.

Of candidates that are equally good within a tolerance the first is chosen, so that rounding seldom affects
the choice.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum, minimum
from carom.kernels.structs import Candidate, CandidateRows
from carom.kernels.types import Int32, Vector3, func, real, shared_func

# Points closer together than this count as one [m].
SAME_POINT = real(1.0e-6)
# Candidates at most this much less deep than the deepest count as equally deep [m]. So the same corners of a
# face that lies flat are chosen in every step.
AS_DEEP = real(1.0e-7)
# Relative amount by which a later candidate must be better to be preferred.
CLEARLY = real(1.0e-6)
# The squared length of a unit normal differs from 1 by less.
NEARLY_UNIT = real(1.0e-3)


@func
def is_unit(normal: Vector3) -> bool:
    """Whether a vector has length 1, apart from rounding; false if it is not finite."""
    return wp.abs(wp.length_sq(normal) - 1.0) < NEARLY_UNIT


@func
def add_candidate(
    candidates: CandidateRows, world: Int32, count: Int32, point: Vector3, normal: Vector3, distance: real
) -> Int32:
    """Append a candidate to the first `count`, if there is room; returns the new number.

    Without a unit normal it is left out: rounding can lose the normal where shapes of 1e30 m overlap.
    """
    if count >= candidates.shape[1] or not is_unit(normal):
        return count
    candidate = Candidate()
    candidate.point = point
    candidate.normal = normal
    candidate.distance = distance
    candidates[world, count] = candidate
    return count + 1


@func
def candidate_on_a(candidates: CandidateRows, world: Int32, row: Int32) -> Vector3:
    """Point on shape a."""
    distance = candidates[world, row].distance
    return candidates[world, row].point + candidates[world, row].normal * distance


@func
def exchange(candidates: CandidateRows, world: Int32, i: Int32, j: Int32):
    """Swap two candidates."""
    kept = candidates[world, i]
    candidates[world, i] = candidates[world, j]
    candidates[world, j] = kept


@func
def flip_candidates(candidates: CandidateRows, world: Int32, count: Int32):
    """Turn the candidates of shapes (a, b) into candidates of shapes (b, a)."""
    for row in range(count):
        normal = candidates[world, row].normal
        distance = candidates[world, row].distance
        point = candidate_on_a(candidates, world, row)
        add_candidate(candidates, world, row, point, -normal, distance)


@func
def deepest_outermost(candidates: CandidateRows, world: Int32, count: Int32) -> Int32:
    """Row of the one among the deepest candidates that is farthest from the mean of all points."""
    deepest = candidates[world, 0].distance
    middle = Vector3(0.0, 0.0, 0.0)
    for row in range(count):
        deepest = minimum(deepest, candidates[world, row].distance)
        middle += candidates[world, row].point / real(count)
    best = Int32(0)
    most = real(-1.0)
    for row in range(count):
        score = wp.length_sq(candidates[world, row].point - middle)
        if candidates[world, row].distance <= deepest + AS_DEEP and score > most * (1.0 + CLEARLY):
            most = score
            best = Int32(row)
    return best


@shared_func
def keep_four(candidates: CandidateRows, world: Int32, count: Int32) -> Int32:
    """Choose at most four candidates that span the contact and put them first; returns their number.

    The deepest (of several equally deep ones the outermost), the one farthest from it, the one farthest from
    the line through these two, and the one farthest outside the triangle of these three.
    """
    if count <= 1:
        return count
    best = deepest_outermost(candidates, world, count)
    exchange(candidates, world, 0, best)
    a = candidates[world, 0].point

    best = Int32(-1)
    most = SAME_POINT * SAME_POINT
    for row in range(1, count):
        score = wp.length_sq(candidates[world, row].point - a)
        if score > most * (1.0 + CLEARLY):
            most = score
            best = row
    if best < 0:
        return 1
    exchange(candidates, world, 1, best)
    b = candidates[world, 1].point

    base = most
    best = Int32(-1)
    most = base * SAME_POINT * SAME_POINT
    for row in range(2, count):
        score = wp.length_sq(wp.cross(b - a, candidates[world, row].point - a))
        if score > most * (1.0 + CLEARLY):
            most = score
            best = row
    if best < 0:
        return 2
    exchange(candidates, world, 2, best)
    c = candidates[world, 2].point

    normal = wp.cross(b - a, c - a)
    best = Int32(-1)
    most = SAME_POINT * SAME_POINT * wp.sqrt(base) * wp.length(normal)
    for row in range(3, count):
        p = candidates[world, row].point
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
