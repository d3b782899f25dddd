"""Least and greatest of two numbers, as kernels that are in a hurry need them.

`wp.min`, `wp.max` and `wp.clamp` look for NaNs first; these are one instruction for each number.
"""

import warp as wp

from carom.kernels.types import Vector3, func, real


@func
def lesser(a: real, b: real) -> real:
    """The lesser of two numbers; a if one is NaN."""
    return wp.where(b < a, b, a)


@func
def greater(a: real, b: real) -> real:
    """The greater of two numbers; a if one is NaN."""
    return wp.where(b > a, b, a)


@func
def within_bounds(value: real, lower: real, upper: real) -> real:
    """The number nearest to `value` from `lower` to `upper`; NaN stays NaN."""
    return lesser(greater(value, lower), upper)


@func
def lower_corner(a: Vector3, b: Vector3) -> Vector3:
    """The lesser coordinate of two points along each axis."""
    return Vector3(lesser(a[0], b[0]), lesser(a[1], b[1]), lesser(a[2], b[2]))


@func
def upper_corner(a: Vector3, b: Vector3) -> Vector3:
    """The greater coordinate of two points along each axis."""
    return Vector3(greater(a[0], b[0]), greater(a[1], b[1]), greater(a[2], b[2]))


@func
def least_entry(vector: Vector3) -> real:
    """The least of three numbers."""
    return lesser(lesser(vector[0], vector[1]), vector[2])


@func
def greatest_entry(vector: Vector3) -> real:
    """The greatest of three numbers."""
    return greater(greater(vector[0], vector[1]), vector[2])
