"""Vectors that a call can do without: one of the wrong length stands for the default.

PyBullet does so without a word, and scripts have come to live with it: colours without opacity, angles where
a quaternion belongs, one factor for three.
"""

from __future__ import annotations

from typing import Any

from carom.description.pose import Quaternion, Vector3
from pybullet._calls.arguments import rotation, vector3, vector4
from pybullet._calls.errors import warn_once


def optional_vector3(values: Any, problem: str, name: str) -> Vector3 | None:
    """Three finite numbers, or None, with a warning where there is something else.

    Args:
        values: The argument.
        problem: PyBullet's text where one of three items is not a finite number.
        name: Of the argument.

    Raises:
        pybullet.error: There are three items, and one is not a finite number.
    """
    return vector3(values, problem, name) if has_length(values, 3, name) else None


def optional_vector4(values: Any, problem: str, name: str) -> tuple[float, float, float, float] | None:
    """Four finite numbers, or None, as `optional_vector3`."""
    return vector4(values, problem, name) if has_length(values, 4, name) else None


def optional_rotation(values: Any, problem: str, name: str) -> Quaternion | None:
    """A quaternion (x, y, z, w) that is a rotation, or None, as `optional_vector3`."""
    return rotation(values, problem, name) if has_length(values, 4, name) else None


def has_length(values: Any, count: int, name: str) -> bool:
    """Whether an argument was given and has that many items; warns where it has others."""
    if values is None:
        return False
    try:
        if len(values) == count:
            return True
    except TypeError:
        pass
    warn_once(f"{name} is not a sequence of {count} numbers, so its default is used")
    return False
