"""Which four of up to eight corners of a clipped face two boxes keep, as Bullet chooses them."""

import math

import warp as wp

from carom.kernels.contact.candidates import candidate_distance, candidate_point, exchange
from carom.kernels.types import Int32, Vector2, Vector3, Vector8Rows, func, real

TURN = real(2.0 * math.pi)
HALF_TURN = real(math.pi)
QUARTER_TURN = real(0.5 * math.pi)
# Corners less deep than the deepest by this are as deep: of what lies flat, the same should stay [m].
ALIKE = real(1.0e-9)
# Twice the area of a polygon below which it has no middle [m²].
NO_AREA = real(1.0e-15)


@func
def place_in_face(
    candidates: Vector8Rows, world: Int32, row: Int32, across1: Vector3, across2: Vector3
) -> Vector2:
    """Where a candidate is along two axes of a face."""
    point = candidate_point(candidates, world, row)
    return Vector2(wp.dot(point, across1), wp.dot(point, across2))


@func
def middle_of_face(
    candidates: Vector8Rows, world: Int32, count: Int32, across1: Vector3, across2: Vector3
) -> Vector2:
    """Centroid of the polygon of all candidates, along two axes of the face."""
    first = place_in_face(candidates, world, 0, across1, across2)
    area = real(0.0)
    moment = Vector2(0.0, 0.0)
    for row in range(1, count - 1):
        here = place_in_face(candidates, world, row, across1, across2) - first
        there = place_in_face(candidates, world, row + 1, across1, across2) - first
        part = here[0] * there[1] - here[1] * there[0]
        area += part
        moment += (here + there) * part
    if wp.abs(area) < NO_AREA:
        return first
    return first + moment / (3.0 * area)


@func
def keep_four_around(
    candidates: Vector8Rows, world: Int32, count: Int32, across1: Vector3, across2: Vector3
) -> Int32:
    """Keep the deepest candidate and those nearest to quarter turns from it around the middle of all.

    Args:
        candidates: Corners of a polygon, one after the other.
        world: The world.
        count: Their number, more than four.
        across1: First axis of the face; quarter turns go from it to the second.
        across2: Second axis of the face.

    Returns:
        Four, in the order in which they were chosen.
    """
    middle = middle_of_face(candidates, world, count, across1, across2)
    best = Int32(0)
    for row in range(1, count):
        deeper = candidate_distance(candidates, world, best) - candidate_distance(candidates, world, row)
        if deeper > ALIKE:
            best = Int32(row)
    place = place_in_face(candidates, world, best, across1, across2) - middle
    start = wp.atan2(place[1], place[0])
    wanted = start
    kept = Int32(0)
    while kept < 4:
        if kept > 0:
            wanted += QUARTER_TURN
            least = TURN
            best = kept + 0
            for row in range(kept, count):
                place = place_in_face(candidates, world, row, across1, across2) - middle
                off = wp.abs(wp.atan2(place[1], place[0]) - wanted)
                while off > HALF_TURN:
                    off = wp.abs(off - TURN)
                if off < least:
                    least = off
                    best = Int32(row)
        # The order of the others decides between those that are as near.
        behind = best + 0
        while behind > kept:
            exchange(candidates, world, behind, behind - 1)
            behind -= 1
        kept += 1
    return 4
