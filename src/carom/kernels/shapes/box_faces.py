"""Contact points of two boxes, one of which touches with a face: which points they are, and in which order.

The *incident* face of the other box is clipped at the sides of the *reference* face. Of more than four points
that touch four are chosen, unless contacts yield as MuJoCo's: there are up to eight then, as there. Order and
choice are Bullet's, because they decide how the load is shared.

Polygons have one row per corner: its coordinates along both axes of the reference face, from the centre of
the face, and its height above the face.
"""

import math

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.boxes import main_axis
from carom.kernels.shapes.cores import toward
from carom.kernels.structs import CandidateRows
from carom.kernels.types import Int32, Matrix3, Vector3, Vector3Rows, func, real, shared_func

# Maximum number of points.
MOST = 4
# Half a turn: pi in single precision, as in Bullet. It decides between points that are equally near to a
# quarter turn.
HALF_TURN = real(3.1415927410125732)
# Points less deep than the deepest by this are as deep; so the same points of a box that lies flat are
# chosen in every step [m].
ALIKE = real(1.0e-9)
# Twice the area of a polygon below which it has no centroid [m²].
NO_AREA = real(math.ulp(1.0))


@func
def incident_axis(direction: Vector3) -> Int32:
    """Axis of the component with the largest magnitude; of equal ones the last, or else the first."""
    size = wp.abs(direction)
    axis = Int32(wp.where(size[1] > size[0], 1, 0))
    return axis if size[axis] > size[2] else Int32(2)


@func
def clip_at(
    polygon: Vector3Rows, clipped: Vector3Rows, world: Int32, count: Int32, along: Int32, limit: real
) -> Int32:
    """Clip a polygon at a limit [m] of a coordinate, 0 or 1; an upper limit if positive, else a lower one.

    Corners on the limit count as outside. The polygon is replaced; `clipped` is workspace for corners.
    Returns the number of corners left.
    """
    kept = Int32(0)
    way = toward(limit, 1.0)
    for i in range(count):
        here = polygon[world, i]
        there = polygon[world, wp.where(i + 1 == count, 0, i + 1)]
        inside = way * here[along] < way * limit
        if inside:
            clipped[world, kept] = here
            kept += 1
        if inside != (way * there[along] < way * limit):
            crossing = here + (there - here) / (there[along] - here[along]) * (limit - here[along])
            crossing[along] = limit
            clipped[world, kept] = crossing
            kept += 1
    for i in range(kept):
        polygon[world, i] = clipped[world, i]
    return kept


@func
def centroid(polygon: Vector3Rows, world: Int32, count: Int32) -> Vector3:
    """Centroid of a polygon of at least three corners in the plane of the reference face."""
    first = polygon[world, 0]
    area = real(0.0)
    moment = Vector3(0.0, 0.0, 0.0)
    for i in range(1, count - 1):
        here = polygon[world, i] - first
        there = polygon[world, i + 1] - first
        part = here[0] * there[1] - here[1] * there[0]
        area += part
        moment += (here + there) * part
    return first if wp.abs(area) < NO_AREA else first + moment / (3.0 * area)


@func
def put_forward(polygon: Vector3Rows, angles: Vector3Rows, world: Int32, row: Int32, place: Int32):
    """Move a corner and its angle forward to row `place`; those in between keep their order."""
    corner = polygon[world, row]
    angle = angles[world, row]
    behind = row + 0
    while behind > place:
        polygon[world, behind] = polygon[world, behind - 1]
        angles[world, behind] = angles[world, behind - 1]
        behind -= 1
    polygon[world, place] = corner
    angles[world, place] = angle


@func
def keep_four_around(polygon: Vector3Rows, angles: Vector3Rows, world: Int32, count: Int32):
    """Put the deepest of more than four corners first, then those nearest to quarter turns from it.

    `angles` is workspace for the angles of the corners, as seen from the centroid.
    """
    middle = centroid(polygon, world, count)
    best = Int32(0)
    for row in range(count):
        corner = polygon[world, row]
        angles[world, row] = Vector3(wp.atan2(corner[1] - middle[1], corner[0] - middle[0]), 0.0, 0.0)
        if polygon[world, best][2] - corner[2] > ALIKE:
            best = Int32(row)
    put_forward(polygon, angles, world, best, 0)
    start = angles[world, 0][0]
    place = Int32(1)
    while place < MOST:
        wanted = start + real(place) * (0.5 * HALF_TURN)
        if wanted > HALF_TURN:
            wanted -= 2.0 * HALF_TURN
        least = 4.0 * HALF_TURN
        best = place + 0
        for row in range(place, count):
            off = wp.abs(angles[world, row][0] - wanted)
            if off > HALF_TURN:
                off = 2.0 * HALF_TURN - off
            if off < least:
                least = off
                best = Int32(row)
        put_forward(polygon, angles, world, best, place)
        place += 1


@shared_func
def box_face_points(
    frame: Matrix3,
    half: Vector3,
    position: Vector3,
    outward: Vector3,
    other_frame: Matrix3,
    other_half: Vector3,
    other_position: Vector3,
    reference_is_a: Int32,
    max_distance: real,
    most: Int32,
    polygon: Vector3Rows,
    workspace: Vector3Rows,
    candidates: CandidateRows,
    world: Int32,
) -> Int32:
    """Write the candidates of a box that touches another box with one of its faces; returns their number.

    Boxes are rotation matrix, half extents and centre in world axes, first the box with the reference face,
    whose outward normal is `outward`; `reference_is_a` is 1 if this is shape a, 0 if it is b. `max_distance`
    is the largest distance of a contact [m], `most` is 4, or else 8, their greatest number; `polygon` and
    `workspace` are for corners.
    """
    axis = main_axis(wp.transpose(frame) * outward)
    across1, across2 = Int32(wp.where(axis == 0, 1, 0)), Int32(wp.where(axis == 2, 1, 2))
    to_face = wp.matrix_from_rows(column(frame, across1), column(frame, across2), outward)
    local = wp.transpose(other_frame) * outward
    facing = incident_axis(local)
    side1, side2 = Int32(wp.where(facing == 0, 1, 0)), Int32(wp.where(facing == 2, 1, 2))
    inward = column(other_frame, facing) * toward(local[facing], other_half[facing])
    center = to_face * (other_position - position - inward)
    center[2] -= half[axis]
    edge1 = (to_face * column(other_frame, side1)) * other_half[side1]
    edge2 = (to_face * column(other_frame, side2)) * other_half[side2]
    polygon[world, 0] = center - edge1 - edge2
    polygon[world, 1] = center - edge1 + edge2
    polygon[world, 2] = center + edge1 + edge2
    polygon[world, 3] = center + edge1 - edge2
    count = Int32(4)
    for along in range(2):
        limit = half[wp.where(along == 0, across1, across2)]
        count = clip_at(polygon, workspace, world, count, along, -limit)
        count = clip_at(polygon, workspace, world, count, along, limit)
    touching = Int32(0)
    for row in range(count):
        corner = polygon[world, row]
        if corner[2] <= max_distance:
            polygon[world, touching] = corner
            touching += 1
    if most == MOST and touching > MOST:
        keep_four_around(polygon, workspace, world, touching)
        touching = Int32(MOST)
    normal = -outward if reference_is_a == 1 else outward
    for row in range(touching):
        corner = polygon[world, row]
        height = half[axis]
        if reference_is_a == 1:
            height += corner[2]
        point = position + wp.transpose(to_face) * Vector3(corner[0], corner[1], height)
        add_candidate(candidates, world, row, point, normal, corner[2])
    return touching
