"""Contact points of two touching faces: one face is clipped at the sides of the other."""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.maths.rotation import column
from carom.kernels.shapes.boxes import main_axis
from carom.kernels.shapes.cores import Core
from carom.kernels.structs import CandidateRows
from carom.kernels.types import Int32, Vector3, Vector3Rows, func, real, shared_func
from carom.layouts.codes import BOX


@func
def clip_by_side(
    polygon: Vector3Rows, clipped: Vector3Rows, world: Int32, count: Int32, point: Vector3, outward: Vector3
) -> Int32:
    """Clip a polygon, or a line of two corners, at a plane; returns the number of corners left."""
    inside = Int32(0)
    for i in range(count):
        if wp.dot(polygon[world, i] - point, outward) <= 0.0:
            inside += 1
    if inside == count:
        return count
    kept = Int32(0)
    edges = Int32(1) if count == 2 else count
    room = clipped.shape[1]
    here = polygon[world, 0]
    height = wp.dot(here - point, outward)
    for i in range(edges):
        following = i + 1
        if following == count:
            following = Int32(0)
        there = polygon[world, following]
        height_there = wp.dot(there - point, outward)
        if height <= 0.0 and kept < room:
            clipped[world, kept] = here
            kept += 1
        if (height < 0.0 and height_there > 0.0) or (height > 0.0 and height_there < 0.0):
            if kept < room:
                clipped[world, kept] = here + (there - here) * (height / (height - height_there))
                kept += 1
        here = there
        height = height_there
    if count == 2 and height <= 0.0 and kept < room:
        clipped[world, kept] = here
        kept += 1
    for i in range(kept):
        polygon[world, i] = clipped[world, i]
    return kept


@func
def clip_by_box(
    core: Core, axis: Int32, polygon: Vector3Rows, clipped: Vector3Rows, world: Int32, count: Int32
) -> Int32:
    """Clip a polygon at the sides of a box's faces across an axis; returns the number of corners left.

    The sides are taken in Bullet's order, which determines the corner with which the polygon begins.
    """
    left = count
    for side in range(3):
        if side != axis:
            across = column(core.frame, side)
            for way in range(2):
                outward = across * (2.0 * real(way) - 1.0)
                if left > 0:
                    left = clip_by_side(
                        polygon, clipped, world, left, core.position + outward * core.size[side], outward
                    )
    return left


@shared_func
def clip_faces(
    core: Core,
    reference: Vector3Rows,
    reference_count: Int32,
    outward: Vector3,
    incident: Vector3Rows,
    incident_count: Int32,
    clipped: Vector3Rows,
    normal: Vector3,
    reference_is_a: Int32,
    radius_a: real,
    radius_b: real,
    max_distance: real,
    candidates: CandidateRows,
    world: Int32,
    found: Int32,
) -> Int32:
    """Add candidates where the incident face lies over the reference face and near it.

    The reference face belongs to `core`, which is that of a if `reference_is_a` is 1. It has at least three
    corners, counter-clockwise as seen from outside, and the outward normal `outward`. The incident face has
    at least one; it is clipped in place, with `clipped` as workspace. `normal` is the contact's, on b towards
    a; the cores of a and b are rounded by their radii [m].

    Returns:
        Number of candidates, including those already there, `found`.
    """
    count = incident_count
    p = reference[world, reference_count - 1]
    if core.kind == BOX:
        axis = main_axis(wp.transpose(core.frame) * outward)
        count = clip_by_box(core, axis, incident, clipped, world, count)
    else:
        for i in range(reference_count):
            q = reference[world, i]
            if count > 0:
                count = clip_by_side(incident, clipped, world, count, p, wp.cross(q - p, outward))
            p = q
    slope = wp.abs(wp.dot(outward, normal))
    total = found
    for i in range(count):
        v = incident[world, i]
        core_distance = wp.dot(v - p, outward) / slope
        distance = core_distance - radius_a - radius_b
        if distance <= max_distance:
            # The corner is on the core of the incident shape.
            point = v - normal * (core_distance - radius_b) if reference_is_a == 0 else v + normal * radius_b
            total = add_candidate(candidates, world, total, point, normal, distance)
    return total
