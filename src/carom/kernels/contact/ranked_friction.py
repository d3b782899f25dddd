"""How coefficients of friction are combined of which one at least has a rank, as those of MJCF files have.

Such a shape has all its coefficients, and a number of dimensions, MuJoCo's `condim`, that says which of them
count in a contact: with 1 none, with 3 that of lateral friction, with 4 that of spinning friction as well,
with 6 all. 0 stands for 3, as long as the shape has no other coefficients.
"""

import warp as wp

from carom.kernels.maths.min_max import maximum, within_bounds
from carom.kernels.structs import Shapes
from carom.kernels.types import Int32, Vector3, func, real

MAX_FRICTION = real(10.0)
# What counts in a contact is no less, as in MuJoCo.
LEAST_FRICTION = real(1e-5)


@func
def friction_of(shapes: Shapes, world: Int32, shape: Int32) -> Vector3:
    """The coefficients of a shape: lateral, rolling, spinning."""
    return Vector3(
        shapes.shape_lateral_friction[world, shape],
        shapes.shape_rolling_friction[world, shape],
        shapes.shape_spinning_friction[world, shape],
    )


@func
def dimensions_of(friction: Vector3, stated: Int32) -> Int32:
    """The dimensions of a shape with these coefficients."""
    if stated > 0:
        return stated
    if friction[1] > 0.0:
        return Int32(6)
    return wp.where(friction[2] > 0.0, Int32(4), Int32(3))


@func
def within_dimensions(friction: Vector3, dimensions: Int32) -> Vector3:
    """The coefficients that count with so many dimensions, 0 for others."""
    return Vector3(
        wp.where(dimensions > 1, friction[0], real(0.0)),
        wp.where(dimensions > 4, friction[1], real(0.0)),
        wp.where(dimensions > 3, friction[2], real(0.0)),
    )


@func
def friction_alone(shapes: Shapes, world: Int32, shape: Int32) -> Vector3:
    """The coefficients of a shape that count beside shapes without a rank."""
    friction = friction_of(shapes, world, shape)
    return within_dimensions(
        friction, dimensions_of(friction, shapes.shape_friction_dimensions[world, shape])
    )


@func
def ranked_friction(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> Vector3:
    """Combined coefficients of friction of two shapes of which one has a rank: lateral, rolling, spinning.

    If both have one, dimensions and coefficients are those of the higher rank, of equal ones the greater.
    Otherwise coefficients are multiplied as usual, of each shape those that count.
    """
    rank_a, rank_b = shapes.shape_friction_rank[world, a], shapes.shape_friction_rank[world, b]
    if rank_a > 0 and rank_b > 0:
        of_a, of_b = friction_of(shapes, world, a), friction_of(shapes, world, b)
        dimensions_a = dimensions_of(of_a, shapes.shape_friction_dimensions[world, a])
        dimensions_b = dimensions_of(of_b, shapes.shape_friction_dimensions[world, b])
        friction = wp.where(rank_a > rank_b, of_a, of_b)
        dimensions = wp.where(rank_a > rank_b, dimensions_a, dimensions_b)
        if rank_a == rank_b:
            friction = Vector3(
                maximum(of_a[0], of_b[0]), maximum(of_a[1], of_b[1]), maximum(of_a[2], of_b[2])
            )
            dimensions = wp.max(dimensions_a, dimensions_b)
        friction = Vector3(
            maximum(friction[0], LEAST_FRICTION),
            maximum(friction[1], LEAST_FRICTION),
            maximum(friction[2], LEAST_FRICTION),
        )
        return within_dimensions(friction, dimensions)
    alone_a, alone_b = friction_alone(shapes, world, a), friction_alone(shapes, world, b)
    return Vector3(
        within_bounds(alone_a[0] * alone_b[0], -MAX_FRICTION, MAX_FRICTION),
        within_bounds(alone_a[1] * alone_b[0] + alone_b[1] * alone_a[0], -MAX_FRICTION, MAX_FRICTION),
        within_bounds(alone_a[2] * alone_b[0] + alone_b[2] * alone_a[0], -MAX_FRICTION, MAX_FRICTION),
    )
