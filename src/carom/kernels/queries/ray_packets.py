"""Ray packets: four consecutive rays are tested against a box at once.

The same operation on four numbers takes one instruction (SIMD), and rays that are cast together mostly meet
the same boxes.
"""

import warp as wp

from carom.kernels.queries.ray_solids import GRAZE
from carom.kernels.queries.ray_surfaces import inverse_way
from carom.kernels.structs import Rays
from carom.kernels.types import Int32, Vector3, Vector4, func, real

LANES = 4
# Limit of a lane without a valid ray.
NOWHERE = real(-1.0)


@wp.struct
class Packet:
    """Four rays, one in each lane."""

    first: Int32  # ray in the first lane
    end: Int32  # ray after the one in the last lane
    near_x: Vector4  # start of the ray, moved by `GRAZE` to the upper side: for lower sides of boxes
    near_y: Vector4
    near_z: Vector4
    far_x: Vector4  # start of the ray, moved by `GRAZE` to the lower side: for upper sides of boxes
    far_y: Vector4
    far_z: Vector4
    inverse_x: Vector4  # reciprocal of the ray's extent along the axis
    inverse_y: Vector4
    inverse_z: Vector4


@func
def way_of(rays: Rays, ray: Int32) -> Vector3:
    """Vector from the start of a ray to its end."""
    return rays.ray_end[ray] - rays.ray_start[ray]


@func
def packet_of(rays: Rays, first: Int32, count: Int32):
    """Packet of the rays from `first` on, and their limits: fractions after which hits are ignored.

    Rays that are missing or not finite get the limit `NOWHERE`, so they hit nothing.
    """
    packet = Packet()
    limit = Vector4(NOWHERE)
    packet.first = first
    packet.end = wp.min(first + LANES, count)
    for lane in range(LANES):
        ray = wp.min(first + lane, count - 1)
        start = rays.ray_start[ray]
        way = way_of(rays, ray)
        total = start[0] + start[1] + start[2] + way[0] + way[1] + way[2]
        if first + lane == ray and wp.isfinite(total):
            inverse = inverse_way(way)
            packet.near_x[lane] = start[0] + GRAZE
            packet.far_x[lane] = start[0] - GRAZE
            packet.near_y[lane] = start[1] + GRAZE
            packet.far_y[lane] = start[1] - GRAZE
            packet.near_z[lane] = start[2] + GRAZE
            packet.far_z[lane] = start[2] - GRAZE
            packet.inverse_x[lane] = inverse[0]
            packet.inverse_y[lane] = inverse[1]
            packet.inverse_z[lane] = inverse[2]
            limit[lane] = 1.0
    return packet, limit


@func
def minimum(a: Vector4, b: Vector4) -> Vector4:
    """The lesser number of each lane."""
    return Vector4(
        wp.where(a[0] < b[0], a[0], b[0]),
        wp.where(a[1] < b[1], a[1], b[1]),
        wp.where(a[2] < b[2], a[2], b[2]),
        wp.where(a[3] < b[3], a[3], b[3]),
    )


@func
def maximum(a: Vector4, b: Vector4) -> Vector4:
    """The greater number of each lane."""
    return Vector4(
        wp.where(a[0] > b[0], a[0], b[0]),
        wp.where(a[1] > b[1], a[1], b[1]),
        wp.where(a[2] > b[2], a[2], b[2]),
        wp.where(a[3] > b[3], a[3], b[3]),
    )


@func
def length_within(packet: Packet, limit: Vector4, lower: Vector3, upper: Vector3) -> Vector4:
    """Fraction of each ray, up to its limit, inside a box enlarged by `GRAZE`; negative if it misses."""
    one_x = wp.cw_mul(Vector4(lower[0]) - packet.near_x, packet.inverse_x)
    one_y = wp.cw_mul(Vector4(lower[1]) - packet.near_y, packet.inverse_y)
    one_z = wp.cw_mul(Vector4(lower[2]) - packet.near_z, packet.inverse_z)
    other_x = wp.cw_mul(Vector4(upper[0]) - packet.far_x, packet.inverse_x)
    other_y = wp.cw_mul(Vector4(upper[1]) - packet.far_y, packet.inverse_y)
    other_z = wp.cw_mul(Vector4(upper[2]) - packet.far_z, packet.inverse_z)
    enter_xy = maximum(minimum(one_x, other_x), minimum(one_y, other_y))
    enter = maximum(enter_xy, maximum(minimum(one_z, other_z), Vector4(0.0)))
    leave_xy = minimum(maximum(one_x, other_x), maximum(one_y, other_y))
    leave = minimum(leave_xy, minimum(maximum(one_z, other_z), limit))
    return leave - enter


@func
def any_within(lengths: Vector4) -> bool:
    """Whether any ray meets the box, by the lengths that `length_within` returned."""
    return lengths[0] >= 0.0 or lengths[1] >= 0.0 or lengths[2] >= 0.0 or lengths[3] >= 0.0


@func
def meets(packet: Packet, limit: Vector4, lower: Vector3, upper: Vector3) -> bool:
    """Whether any of the rays meets a box; empty boxes have their lower corner above their upper one."""
    return lower[0] <= upper[0] and any_within(length_within(packet, limit, lower, upper))


@func
def lane_of(numbers: Vector4, lane: Int32) -> real:
    """Number in a lane, selected by comparisons: an index would move the vector out of its register."""
    return wp.where(
        lane < 2, wp.where(lane == 0, numbers[0], numbers[1]), wp.where(lane == 2, numbers[2], numbers[3])
    )


@func
def with_lane(numbers: Vector4, lane: Int32, number: real) -> Vector4:
    """Vector with the number in one lane replaced."""
    return Vector4(
        wp.where(lane == 0, number, numbers[0]),
        wp.where(lane == 1, number, numbers[1]),
        wp.where(lane == 2, number, numbers[2]),
        wp.where(lane == 3, number, numbers[3]),
    )
