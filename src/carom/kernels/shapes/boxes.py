"""Separating axis test of two boxes with sharp edges: finds the axis along which they overlap least."""

import math

import warp as wp

from carom.kernels.contact.bounds import magnitudes
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.cores import toward
from carom.kernels.types import Int32, Matrix3, Vector3, func, real, shared_func

# Result of `box_axis`: the normal of a face of a, or of b; boxes too far apart; or 3 + 3 i + j for the edges
# along axis i of a and axis j of b.
FACE_A, FACE_B, APART, EDGES = 0, 1, 2, 3
# The gap of an edge axis must exceed that of a face axis by this share, so that contacts do not alternate.
EDGE_SHARE = real(0.05)
# Edges reach further than they do by this share of the boxes' half extents: where boxes just touch, all gaps
# are equal.
EDGE_REACH = real(1.0e-5)
# Squared sine of the angle below which edges are parallel; the face axes are then sufficient.
PARALLEL_SQ = real(math.ulp(1.0) ** 2)
# Squared sine of the angle up to which edges have no nearest points.
NEARLY_PARALLEL = real(1.0e-4)


@func
def main_axis(direction: Vector3) -> Int32:
    """Axis of the component of a vector with the largest magnitude."""
    size = wp.abs(direction)
    axis = Int32(0)
    if size[1] > size[axis]:
        axis = Int32(1)
    if size[2] > size[axis]:
        axis = Int32(2)
    return axis


@shared_func
def box_axis(
    frame_a: Matrix3, half_a: Vector3, frame_b: Matrix3, half_b: Vector3, offset: Vector3, max_distance: real
):
    """Separating axis test of two boxes, given by rotation matrices and half extents.

    `offset` is the vector from the centre of a to that of b, in world axes. The test ends at an axis along
    which the boxes are further apart than `max_distance` [m].

    Returns:
        The kind of axis (see `FACE_A`), its unit vector from b towards a in world axes, and the distance of
        the boxes along it, negative where they overlap. If the centres coincide along the axis, the unit
        vector has the negative direction of the axis.
    """
    turn = wp.transpose(frame_a) * frame_b
    t = wp.transpose(frame_a) * offset
    size = magnitudes(turn)
    t_in_b = wp.transpose(frame_b) * offset
    gaps_a = Vector3(0.0, 0.0, 0.0)
    gaps_b = Vector3(0.0, 0.0, 0.0)
    for i in range(3):
        # Summed in Bullet's order: rounding decides where boxes just touch, and between parallel faces.
        reach_a = half_a[i] + half_b[0] * size[i, 0] + half_b[1] * size[i, 1] + half_b[2] * size[i, 2]
        reach_b = half_a[0] * size[0, i] + half_a[1] * size[1, i] + half_a[2] * size[2, i] + half_b[i]
        gaps_a[i] = wp.abs(t[i]) - reach_a
        gaps_b[i] = wp.abs(t_in_b[i]) - reach_b

    code = Int32(FACE_A)
    axis = Int32(0)
    best = gaps_a[0]
    if gaps_a[1] > best:
        best = gaps_a[1]
        axis = Int32(1)
    if gaps_a[2] > best:
        best = gaps_a[2]
        axis = Int32(2)
    normal = column(frame_a, axis) * -toward(t[axis], 1.0)
    for i in range(3):
        if gaps_b[i] > best:
            best = gaps_b[i]
            code = Int32(FACE_B)
            normal = column(frame_b, i) * -toward(t_in_b[i], 1.0)
    if best > max_distance:
        return Int32(APART), normal, best

    pair = Int32(0)
    while pair < 9:
        i = pair // 3
        j = pair % 3
        j1, j2 = (j + 1) % 3, (j + 2) % 3
        i1, i2 = (i + 1) % 3, (i + 2) % 3
        length_sq = turn[i1, j] * turn[i1, j] + turn[i2, j] * turn[i2, j]
        if length_sq > PARALLEL_SQ:
            # Offset and extents of the boxes along the cross product of axis i of a with axis j of b.
            along = t[i2] * turn[i1, j] - t[i1] * turn[i2, j]
            max_distance_a = half_a[i1] * size[i2, j] + half_a[i2] * size[i1, j]
            max_distance_b = half_b[j1] * size[i, j2] + half_b[j2] * size[i, j1]
            reach = max_distance_a + max_distance_b
            reach += EDGE_REACH * (half_a[i1] + half_a[i2] + half_b[j1] + half_b[j2])
            apart = wp.abs(along) - reach
            # Gaps are negative where boxes overlap.
            needed = best / (1.0 + EDGE_SHARE) if best <= 0.0 else best * (1.0 + EDGE_SHARE)
            # The length is at most 1: a negative gap is at most `apart`.
            if apart > needed or apart > 0.0:
                length = wp.sqrt(length_sq)
                if apart / length > needed:
                    best = apart / length
                    code = EDGES + pair
                    cross = wp.cross(column(frame_a, i), column(frame_b, j))
                    normal = cross * (-toward(along, 1.0) / length)
        pair += 1
    if code >= EDGES and best > max_distance:
        return Int32(APART), normal, best
    return code, normal, best


@shared_func
def box_edge_point(
    frame_a: Matrix3,
    half_a: Vector3,
    frame_b: Matrix3,
    half_b: Vector3,
    center_a: Vector3,
    center_b: Vector3,
    code: Int32,
    normal: Vector3,
) -> Vector3:
    """Point on the edge of b that `box_axis` found, where it is nearest to the edge of a.

    The middle of the edge of b, if the edges are nearly parallel.
    """
    i = (code - EDGES) // 3
    j = (code - EDGES) % 3
    middle_a = center_a
    middle_b = center_b
    for k in range(3):
        side_a, side_b = column(frame_a, k), column(frame_b, k)
        if k != i:
            middle_a += side_a * toward(-wp.dot(side_a, normal), half_a[k])
        if k != j:
            middle_b += side_b * toward(wp.dot(side_b, normal), half_b[k])
    axis_a = column(frame_a, i)
    axis_b = column(frame_b, j)
    along = wp.dot(axis_a, axis_b)
    sine_sq = 1.0 - along * along
    if sine_sq <= NEARLY_PARALLEL:
        return middle_b
    offset = middle_a - middle_b
    return middle_b + axis_b * ((wp.dot(axis_b, offset) - along * wp.dot(axis_a, offset)) / sine_sq)
