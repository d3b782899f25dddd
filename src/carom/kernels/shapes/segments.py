"""Contact candidates of spheres and capsules: segments with a radius, of length zero for spheres."""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.structs import CandidateRows
from carom.kernels.types import Int32, Vector3, func, real, shared_func

# Squared sine of the angle below which segments count as parallel.
PARALLEL = real(1.0e-12)
TINY = real(1.0e-30)


@func
def any_perpendicular(direction: Vector3) -> Vector3:
    """Unit vector perpendicular to `direction`, which may have any length; (1, 0, 0) for length 0."""
    if wp.length_sq(direction) < TINY:
        return Vector3(1.0, 0.0, 0.0)
    size = wp.abs(direction)
    aside = Vector3(1.0, 0.0, 0.0)
    if size[1] < size[0] and size[1] <= size[2]:
        aside = Vector3(0.0, 1.0, 0.0)
    elif size[2] < size[0]:
        aside = Vector3(0.0, 0.0, 1.0)
    return wp.normalize(wp.cross(direction, aside))


@func
def nearest_places(offset: Vector3, half_a: Vector3, half_b: Vector3):
    """Nearest points of two segments, as coordinates between -1 and 1 along their half vectors.

    `offset` is the vector from the middle of b to that of a. Half vectors go from the middle to one end; they
    may be zero.
    """
    aa = wp.length_sq(half_a)
    bb = wp.length_sq(half_b)
    ab = wp.dot(half_a, half_b)
    a_offset, b_offset = wp.dot(half_a, offset), wp.dot(half_b, offset)
    determinant = aa * bb - ab * ab
    place_a = real(0.0)
    if determinant > PARALLEL * aa * bb:
        place_a = wp.clamp((ab * b_offset - bb * a_offset) / determinant, -1.0, 1.0)
    place_b = wp.clamp((ab * place_a + b_offset) / bb, -1.0, 1.0) if bb > TINY else 0.0
    if aa > TINY:
        place_a = wp.clamp((ab * place_b - a_offset) / aa, -1.0, 1.0)
    if bb > TINY:
        place_b = wp.clamp((ab * place_a + b_offset) / bb, -1.0, 1.0)
    return place_a, place_b


@func
def add_round_contact(
    candidates: CandidateRows,
    world: Int32,
    count: Int32,
    point_a: Vector3,
    radius_a: real,
    point_b: Vector3,
    radius_b: real,
    fallback: Vector3,
    max_distance: real,
) -> Int32:
    """Add the candidate of two spheres; `fallback` is the normal if their centres coincide."""
    offset = point_a - point_b
    length = wp.length(offset)
    distance = length - radius_a - radius_b
    if distance > max_distance:
        return count
    normal = offset / length if length * length > TINY else fallback
    return add_candidate(candidates, world, count, point_b + normal * radius_b, normal, distance)


@shared_func
def collide_segments(
    middle_a: Vector3,
    half_a: Vector3,
    radius_a: real,
    middle_b: Vector3,
    half_b: Vector3,
    radius_b: real,
    max_distance: real,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """Write the candidates of two segments with radii: one, or two if they are parallel side by side."""
    offset = middle_a - middle_b
    across = wp.cross(half_a, half_b)
    lengths = wp.length_sq(half_a) * wp.length_sq(half_b)
    fallback = any_perpendicular(half_a + half_b)
    if lengths > TINY and wp.length_sq(across) > PARALLEL * lengths:
        fallback = wp.normalize(across)
    if lengths > TINY and wp.length_sq(across) <= PARALLEL * lengths:
        # Ends of the part of a that has b beside it.
        unit = half_a / wp.length_sq(half_a)
        middle = wp.dot(-offset, unit)
        along = wp.abs(wp.dot(half_b, unit))
        start = wp.max(middle - along, -1.0)
        end = wp.min(middle + along, 1.0)
        if start < end:
            count = Int32(0)
            for side in range(2):
                place = end if side == 1 else start
                point_a = middle_a + half_a * place
                place_b = wp.dot(point_a - middle_b, half_b) / wp.length_sq(half_b)
                point_b = middle_b + half_b * wp.clamp(place_b, -1.0, 1.0)
                count = add_round_contact(
                    candidates, world, count, point_a, radius_a, point_b, radius_b, fallback, max_distance
                )
            return count
    place_a, place_b = nearest_places(offset, half_a, half_b)
    return add_round_contact(
        candidates, world, 0, middle_a + half_a * place_a, radius_a, middle_b + half_b * place_b, radius_b,
        fallback, max_distance,
    )  # fmt: skip
