"""Least and greatest of two numbers, as kernels that are in a hurry need them.

`wp.min`, `wp.max` and `wp.clamp` look for NaNs first; these are one instruction for each number.
"""

import warp as wp

from carom.kernels.types import Vector3, func, real


@func
def minimum(a: real, b: real) -> real:
    """The lesser of two numbers; a if one is NaN."""
    return wp.where(b < a, b, a)


@func
def maximum(a: real, b: real) -> real:
    """The greater of two numbers; a if one is NaN."""
    return wp.where(b > a, b, a)


@func
def within_bounds(value: real, lower: real, upper: real) -> real:
    """The number nearest to `value` from `lower` to `upper`; NaN stays NaN."""
    return minimum(maximum(value, lower), upper)


@func
def lower_corner(a: Vector3, b: Vector3) -> Vector3:
    """The lesser coordinate of two points along each axis."""
    return Vector3(minimum(a[0], b[0]), minimum(a[1], b[1]), minimum(a[2], b[2]))


@func
def upper_corner(a: Vector3, b: Vector3) -> Vector3:
    """The greater coordinate of two points along each axis."""
    return Vector3(maximum(a[0], b[0]), maximum(a[1], b[1]), maximum(a[2], b[2]))


@func
def least_entry(vector: Vector3) -> real:
    """The least of three numbers."""
    return minimum(minimum(vector[0], vector[1]), vector[2])


@func
def greatest_entry(vector: Vector3) -> real:
    """The greatest of three numbers."""
    return maximum(maximum(vector[0], vector[1]), vector[2])
