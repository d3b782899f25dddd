"""Minimum, maximum and clamp without a test for NaN.

`wp.min`, `wp.max` and `wp.clamp` test for NaN first; these functions take one instruction per comparison.
"""

import warp as wp

from carom.kernels.types import Vector3, func, real


@func
def minimum(a: real, b: real) -> real:
    """Minimum of two numbers; a if one is NaN."""
    return wp.where(b < a, b, a)


@func
def maximum(a: real, b: real) -> real:
    """Maximum of two numbers; a if one is NaN."""
    return wp.where(b > a, b, a)


@func
def later_maximum(before: real, value: real) -> real:
    """Maximum of two numbers; `value` if one is NaN: in Bullet's loops what was before NaN is forgotten."""
    return wp.where(before > value, before, value)


INDEFINITE = real(float("nan"))
"""Change of the velocity of a row along which nothing can move, 0/0; see `later_maximum`."""


@func
def within_bounds(value: real, lower: real, upper: real) -> real:
    """Clamp `value` to [lower, upper]; NaN stays NaN.

    Where a motor's greatest force is negative, `lower` is above `upper`: as in Bullet, what is below `lower`
    becomes `lower` then, and everything else `upper`.
    """
    return wp.where(value < lower, lower, minimum(value, upper))


@func
def lower_corner(a: Vector3, b: Vector3) -> Vector3:
    """Minimum of two points, component by component."""
    return Vector3(minimum(a[0], b[0]), minimum(a[1], b[1]), minimum(a[2], b[2]))


@func
def upper_corner(a: Vector3, b: Vector3) -> Vector3:
    """Maximum of two points, component by component."""
    return Vector3(maximum(a[0], b[0]), maximum(a[1], b[1]), maximum(a[2], b[2]))


@func
def least_entry(vector: Vector3) -> real:
    """Minimum of three numbers."""
    return minimum(minimum(vector[0], vector[1]), vector[2])


@func
def greatest_entry(vector: Vector3) -> real:
    """Maximum of three numbers."""
    return maximum(maximum(vector[0], vector[1]), vector[2])
