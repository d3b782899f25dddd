"""Rays that miss a convex shape by up to a millimetre hit it, as in PyBullet.

PyBullet goes along the ray in steps, each as long as the distance from the shape allows, until the shape is
at most a millimetre away (conservative advancement). So a ray in the plane of a box's face, whose exact test
depends on rounding, hits the edge that it meets first. Only rays are examined here that the exact test has
miss, or hit at a very small angle; most of those are done after a test with a shape a millimetre larger.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum
from carom.kernels.queries.ray_hulls import ray_hull
from carom.kernels.queries.ray_solids import (
    GRAZE,
    MISS,
    THICKNESS,
    ray_ball,
    ray_box,
    ray_capsule,
    ray_cylinder,
    ray_from_margin,
)
from carom.kernels.soft.nearest import away_from, on_box, on_cylinder, on_hull
from carom.kernels.structs import Shapes
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, HULL, SPHERE

_MAX_STEPS = 64
_FAR = real(1.0e18)
# A point is on a surface if it is no farther from it [m].
_ON_SURFACE = real(1.0e-12)
# A ray whose direction and normal have a product less than this, for unit vectors, goes along the surface.
_ALONG = real(1.0e-12)
# The same product, above which a hit is that of the exact test: there a ray is near for less than 2 cm.
_SMALL_SLOPE = real(0.05)


@func
def is_convex(kind: Int32) -> bool:
    """Whether shapes of a kind are solids that rays can graze."""
    return kind == SPHERE or kind == BOX or kind == CAPSULE or kind == CYLINDER or kind == HULL


@func
def may_graze(fraction: real, normal: Vector3, way: Vector3) -> bool:
    """Whether a ray misses a shape, or hits it at such a small angle that it may have come near it before."""
    slope = wp.dot(way, normal)
    return fraction > 1.0 or slope * slope < _SMALL_SLOPE * _SMALL_SLOPE * wp.length_sq(way)


@func
def enters_larger(shapes: Shapes, world: Int32, shape: Int32, start: Vector3, way: Vector3) -> real:
    """Fraction at which a ray enters the shape enlarged by `GRAZE`, in the shape frame, or `MISS`."""
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[world, shape]
    fraction = real(MISS)
    _normal = Vector3(0.0, 0.0, 0.0)
    if kind == BOX:
        fraction, _normal = ray_box(start, way, size + Vector3(GRAZE, GRAZE, GRAZE))
    elif kind == SPHERE:
        fraction, _normal = ray_ball(start, way, Vector3(0.0, 0.0, 0.0), size[0] + GRAZE)
    elif kind == CAPSULE:
        fraction, _normal = ray_capsule(start, way, size[0] + GRAZE, size[1])
    elif kind == CYLINDER:
        fraction, _normal = ray_cylinder(start, way, size[0] + GRAZE, size[1] + GRAZE)
    else:
        fraction, _normal = ray_hull(
            start, way, shapes.face_plane, shapes.shape_first_face[shape],
            shapes.shape_face_count[shape], shapes.shape_margin[world, shape] + GRAZE,
        )  # fmt: skip
    return fraction


@func
def rounded_core(length: real) -> real:
    """Half a length of a box or cylinder without the margin around its core."""
    return maximum(length - THICKNESS, real(0.0))


@func
def distance_from(shapes: Shapes, world: Int32, shape: Int32, point: Vector3):
    """Distance of a point from a shape with rounded edges, and the outward normal, in the shape frame."""
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[world, shape]
    distance = real(0.0)
    normal = Vector3(0.0, 0.0, 1.0)
    if kind == BOX:
        core = Vector3(rounded_core(size[0]), rounded_core(size[1]), rounded_core(size[2]))
        distance, normal = on_box(core, point)
        distance -= THICKNESS
    elif kind == CYLINDER:
        distance, normal = on_cylinder(rounded_core(size[0]), rounded_core(size[1]), point)
        distance -= THICKNESS
    elif kind == HULL:
        distance, normal = on_hull(shapes, shape, point, _FAR)
        distance -= shapes.shape_margin[world, shape]
    else:
        half = wp.where(kind == CAPSULE, size[1], real(0.0))
        offset = point - Vector3(0.0, 0.0, wp.clamp(point[2], -half, half))
        distance = wp.length(offset) - size[0]
        normal = away_from(offset, normal)
    return distance, normal


@func
def ray_rounded(shapes: Shapes, world: Int32, shape: Int32, start: Vector3, way: Vector3, entry: real):
    """Ray against a hull that is rounded, in the shape frame; not before the fraction `entry`.

    Along a ray the distance from a convex shape is a convex function, whose first root Newton's method comes
    to from below.
    """
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    at = wp.clamp(entry, real(0.0), real(1.0))
    distance, outward = distance_from(shapes, world, shape, start + way * at)
    if at == 0.0 and distance <= 0.0:
        if distance >= -shapes.shape_margin[world, shape]:
            fraction, normal = ray_from_margin(outward, way)
        return fraction, normal
    steps = Int32(_MAX_STEPS)
    while distance > _ON_SURFACE and steps > 0:
        steps -= 1
        rate = wp.dot(way, outward)
        if distance > -rate * (real(1.0) - at):
            steps = Int32(-1)
        else:
            at -= distance / rate
            distance, outward = distance_from(shapes, world, shape, start + way * at)
    if steps >= 0:
        fraction = at
        normal = outward
    return fraction, normal


@func
def ray_grazing(shapes: Shapes, world: Int32, shape: Int32, start: Vector3, way: Vector3, last: real):
    """Fraction and normal at which a ray that misses a convex shape comes within `GRAZE`, in the shape frame.

    The ray is examined up to the fraction `last`.
    """
    fraction, normal = real(MISS), Vector3(0.0, 0.0, 0.0)
    if enters_larger(shapes, world, shape, start, way) <= last:
        at = real(0.0)
        distance, outward = distance_from(shapes, world, shape, start)
        steps = Int32(_MAX_STEPS)
        while distance > GRAZE and steps > 0:
            steps -= 1
            rate = wp.dot(way, outward)
            # Multiplied instead of divided: a ray that goes away from the shape, or ends before it, is done.
            if distance > -rate * (last - at):
                steps = Int32(0)
            else:
                at -= distance / rate
                distance, outward = distance_from(shapes, world, shape, start + way * at)
        # A ray that started next to a face and goes along it does not hit it; one that came there does.
        approach = wp.dot(way, outward)
        if distance <= GRAZE and (approach < 0.0 or (at > 0.0 and approach <= _ALONG * wp.length(way))):
            fraction = at
            normal = outward
    return fraction, normal
