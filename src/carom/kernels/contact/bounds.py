"""Axis-aligned bounding boxes (AABBs) and poses of all shapes, in world axes."""

import warp as wp

from carom.kernels.dynamics.kinematics import base_velocity
from carom.kernels.maths.min_max import greatest_entry, maximum, upper_corner
from carom.kernels.maths.rotation import rotation_matrix
from carom.kernels.solver.activity import is_absent
from carom.kernels.structs import Model, Pairs, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, Matrix3, Vector3, func, real
from carom.layouts.codes import BOX, CAPSULE, CYLINDER, FIRST_PART, HULL, PLANE, SPHERE
from carom.layouts.contacts import MARGIN
from carom.layouts.model import EVERY_SHAPE

# Half extent of a shape without bounds, such as a plane [m]; its square is still finite.
UNBOUNDED = real(1.0e18)
# How far every shape looks ahead at least where all do [m].
LEAST_AHEAD = real(0.001)
FIRST_WIDENING = real(MARGIN)
"""Margin that hulls have when they are made [m]."""


@func
def is_bounded(shapes: Shapes, shape: Int32) -> bool:
    """Whether a shape has bounds: all but planes."""
    return shapes.shape_kind[shape] != PLANE


@func
def local_center(shapes: Shapes, shape: Int32) -> Vector3:
    """Centre of a shape's bounds in the shape frame."""
    if shapes.shape_kind[shape] > PLANE:
        return shapes.shape_center[shape]
    return Vector3(0.0, 0.0, 0.0)


@func
def local_extents(shapes: Shapes, world: Int32, shape: Int32) -> Vector3:
    """Half extents of a shape's bounds in the shape frame."""
    kind = shapes.shape_kind[shape]
    size = shapes.shape_size[world, shape]
    if kind == SPHERE:
        return Vector3(size[0], size[0], size[0])
    if kind == BOX:
        return size
    if kind == CAPSULE:
        across = size[0] + size[2]
        return Vector3(across, across, across + size[1])
    if kind == CYLINDER:
        return Vector3(size[0], size[0], size[1])
    # Bullet widens hulls twice: their vertices when they are made, and their box by the present margin.
    margin = shapes.shape_margin[world, shape] + wp.where(kind == HULL, FIRST_WIDENING, real(0.0))
    return size + Vector3(margin, margin, margin)


@func
def magnitudes(matrix: Matrix3) -> Matrix3:
    """Absolute values of all entries."""
    return Matrix3(
        wp.abs(matrix[0, 0]), wp.abs(matrix[0, 1]), wp.abs(matrix[0, 2]),
        wp.abs(matrix[1, 0]), wp.abs(matrix[1, 1]), wp.abs(matrix[1, 2]),
        wp.abs(matrix[2, 0]), wp.abs(matrix[2, 1]), wp.abs(matrix[2, 2]),
    )  # fmt: skip


@func
def empty_bounds(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32):
    """Write bounds of a shape that meet no others, not even those of planes."""
    corner = Vector3(2.0 * UNBOUNDED, 2.0 * UNBOUNDED, 2.0 * UNBOUNDED)
    pairs.shape_lower[world, shape] = corner
    pairs.shape_upper[world, shape] = -corner
    if shapes.shape_part[shape] == FIRST_PART:
        pairs.shape_part_lower[world, shape] = corner
        pairs.shape_part_upper[world, shape] = -corner


@func
def place_shape(shapes: Shapes, state: State, pairs: Pairs, world: Int32, shape: Int32):
    """Write the world pose and bounds of one shape; as in Bullet, the box around its rotated local box.

    A shape whose pose is not finite, or whose tree is absent, gets empty bounds, so that it is in no pair.
    The first part of a compound also gets the bounds of its link.
    """
    if is_absent(state, world, shapes.shape_tree[shape]):
        empty_bounds(shapes, pairs, world, shape)
        return
    pose = state.link_pose[world, shapes.shape_link[shape]] * shapes.shape_pose[shape]
    frame = rotation_matrix(wp.transform_get_rotation(pose))
    position = wp.transform_get_translation(pose)
    pairs.shape_position[world, shape] = position
    pairs.shape_frame[world, shape] = frame
    half_extents = Vector3(UNBOUNDED, UNBOUNDED, UNBOUNDED)
    center = Vector3(0.0, 0.0, 0.0)
    kind = shapes.shape_kind[shape]
    if kind == SPHERE:
        # Exact, independent of rounding errors in the rotation.
        center = position
        half_extents = local_extents(shapes, world, shape)
    elif kind != PLANE:
        center = position + frame * local_center(shapes, shape)
        half_extents = magnitudes(frame) * local_extents(shapes, world, shape)
    total = center[0] + center[1] + center[2] + half_extents[0] + half_extents[1] + half_extents[2]
    if not wp.isfinite(total):
        center = Vector3(0.0, 0.0, 0.0)
        half_extents = -Vector3(UNBOUNDED, UNBOUNDED, UNBOUNDED)
    if shapes.shape_part[shape] == FIRST_PART:
        pairs.shape_part_lower[world, shape] = center - half_extents
        pairs.shape_part_upper[world, shape] = center + half_extents
        if kind != PLANE and half_extents[0] >= 0.0:
            link = shapes.shape_link[shape]
            axes = rotation_matrix(wp.transform_get_rotation(state.link_pose[world, link]))
            place = wp.transform_get_translation(state.link_pose[world, link])
            center = place + axes * shapes.link_center[world, link]
            half_extents = magnitudes(axes) * shapes.link_extents[world, link]
    pairs.shape_lower[world, shape] = center - half_extents
    pairs.shape_upper[world, shape] = center + half_extents


@func
def made_bounds(shapes: Shapes, model: Model, state: State, pairs: Pairs, world: Int32, shape: Int32):
    """Minimum and maximum corner of the bounds with which Bullet creates what stands for a link.

    When it creates a body, joints are at 0, and it takes the frames of links for their inertial frames.
    Bounds of planes, and those that are empty, are the present ones.
    """
    lower = pairs.shape_lower[world, shape]
    upper = pairs.shape_upper[world, shape]
    kind = shapes.shape_kind[shape]
    if kind == PLANE or not lower[0] <= upper[0]:
        return lower, upper
    link = shapes.shape_link[shape]
    base = model.tree[shapes.shape_tree[shape]].first_link
    pose = state.link_pose[world, base] * shapes.link_made_pose[link]
    center = shapes.link_center[world, link]
    half_extents = shapes.link_extents[world, link]
    if shapes.shape_part[shape] != FIRST_PART:
        pose = pose * shapes.shape_pose[shape]
        center = local_center(shapes, shape)
        half_extents = local_extents(shapes, world, shape)
    axes = rotation_matrix(wp.transform_get_rotation(pose))
    center = wp.transform_get_translation(pose) + axes * center
    if kind != SPHERE or shapes.shape_part[shape] == FIRST_PART:
        half_extents = magnitudes(axes) * half_extents
    return center - half_extents, center + half_extents


@func
def own_bounds(shapes: Shapes, pairs: Pairs, world: Int32, shape: Int32):
    """Minimum and maximum corner of the bounds of a shape itself, not of its link."""
    if shapes.shape_part[shape] == FIRST_PART:
        return pairs.shape_part_lower[world, shape], pairs.shape_part_upper[world, shape]
    return pairs.shape_lower[world, shape], pairs.shape_upper[world, shape]


@func
def look_ahead(
    shapes: Shapes,
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    shape: Int32,
) -> real:
    """Distance that continuous collision detection looks ahead of a shape [m].

    The shape's motion in the last substep (since `Scratch.link_pose`) or the motion of its base in the
    next one, whichever is larger. Zero if this is at most half the radius of the shape's swept sphere:
    contacts of slower shapes are found in time without looking ahead.

    Where contacts are rigid, all shapes look ahead, and at least a little: so no contact is found too late,
    and manifolds have all of their points at once.
    """
    radius = shapes.shape_ccd_radius[shape]
    if radius <= 0.0 and settings.looks_ahead != EVERY_SHAPE:
        return 0.0
    link = shapes.shape_link[shape]
    now = wp.transform_get_translation(state.link_pose[world, link] * shapes.shape_pose[shape])
    before = wp.transform_get_translation(scratch.link_pose[world, link] * shapes.shape_pose[shape])
    motion = wp.length(now - before)
    tree = shapes.shape_tree[shape]
    motion = maximum(motion, wp.length(base_velocity(model, state, world, tree)) * settings.time_step)
    if settings.looks_ahead == EVERY_SHAPE:
        return motion + LEAST_AHEAD if motion < UNBOUNDED else LEAST_AHEAD
    return motion if motion > 0.5 * radius and motion < UNBOUNDED else 0.0


@func
def place_shapes(shapes: Shapes, state: State, settings: Settings, pairs: Pairs, world: Int32):
    """Write the world poses and bounds of all shapes."""
    for shape in range(settings.shape_count):
        place_shape(shapes, state, pairs, world, shape)


@func
def gap_between(lower_a: Vector3, upper_a: Vector3, lower_b: Vector3, upper_b: Vector3) -> real:
    """Largest distance of two boxes along any axis [m]; negative if they overlap."""
    return greatest_entry(upper_corner(lower_a - upper_b, lower_b - upper_a))


@func
def boxes_meet(
    lower_a: Vector3, upper_a: Vector3, lower_b: Vector3, upper_b: Vector3, max_distance: real
) -> bool:
    """Whether two boxes are at most `max_distance` apart along every axis."""
    return gap_between(lower_a, upper_a, lower_b, upper_b) <= max_distance
