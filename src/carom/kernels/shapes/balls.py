"""Contact candidate of a sphere on a box or cylinder: the nearest point of the core of box or cylinder."""

import warp as wp

from carom.kernels.contact.candidates import add_candidate
from carom.kernels.shapes.cores import Core, toward
from carom.kernels.structs import CandidateRows
from carom.kernels.types import Int32, Vector3, func, real, shared_func
from carom.layouts.codes import BOX

TINY = real(1.0e-15)


@func
def nearest_in_box(point: Vector3, size: Vector3):
    """Nearest point of a box's surface to a point, and normal and distance there; all in the box's frame.

    For a point inside the box, the nearest face is used and the distance is negative.
    """
    nearest = wp.max(-size, wp.min(point, size))
    offset = point - nearest
    distance = wp.length(offset)
    if distance > TINY:
        return nearest, offset / distance, distance
    axis = Int32(0)
    depth = size[0] - wp.abs(point[0])
    for other in range(1, 3):
        room = size[other] - wp.abs(point[other])
        if room < depth:
            depth = room
            axis = Int32(other)
    normal = Vector3(0.0, 0.0, 0.0)
    normal[axis] = toward(point[axis], 1.0)
    nearest[axis] = toward(point[axis], size[axis])
    return nearest, normal, -depth


@func
def nearest_in_cylinder(point: Vector3, radius: real, half_length: real):
    """Nearest point of a cylinder's surface to a point, and normal and distance, as `nearest_in_box`."""
    radial = wp.sqrt(point[0] * point[0] + point[1] * point[1])
    outward = Vector3(point[0] / radial, point[1] / radial, 0.0) if radial > TINY else Vector3(1.0, 0.0, 0.0)
    side = radial - radius
    cap = wp.abs(point[2]) - half_length
    axis = Vector3(0.0, 0.0, toward(point[2], 1.0))
    if side <= 0.0 and cap <= 0.0:
        if side > cap:
            return point - outward * side, outward, side
        return point - axis * cap, axis, cap
    offset = outward * wp.max(side, 0.0) + axis * wp.max(cap, 0.0)
    distance = wp.length(offset)
    normal = offset / distance if distance > TINY else outward if side > cap else axis
    return point - offset, normal, distance


@shared_func
def collide_ball(
    center: Vector3, radius: real, core: Core, max_distance: real, candidates: CandidateRows, world: Int32
) -> Int32:
    """Write the candidate of a sphere, shape a, on the core of a box or cylinder, shape b.

    Returns:
        Number of candidates: 1, or 0 if the shapes are too far apart.
    """
    local = wp.transpose(core.frame) * (center - core.position)
    if core.kind == BOX:
        nearest, normal, distance = nearest_in_box(local, core.size)
    else:
        nearest, normal, distance = nearest_in_cylinder(local, core.size[0], core.size[1])
    gap = distance - radius - core.radius
    if gap > max_distance:
        return 0
    point = core.position + core.frame * (nearest + normal * core.radius)
    return add_candidate(candidates, world, 0, point, core.frame * normal, gap)
