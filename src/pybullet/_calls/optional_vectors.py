"""Optional vectors: if one has the wrong length, a warning is logged and the default is used.

PyBullet uses the default without a warning, and scripts depend on that: they pass colours without opacity,
Euler angles instead of a quaternion, or one factor instead of three.
"""

from __future__ import annotations

from typing import Any

from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.description.transform import quaternion_from_matrix, rotation_matrix
from pybullet._calls.arguments import rotation, vector3, vector4
from pybullet._calls.errors import warn_once

_USUAL = frozenset((list, tuple))


def optional_vector3(values: Any, problem: str, name: str) -> Vector3 | None:
    """Three finite numbers; None if not given or, with a warning, if the length is not three.

    Raises `pybullet.error` if there are three items, and one is not a finite number.
    """
    if type(values) in _USUAL and len(values) == 3:
        return vector3(values, problem, name)
    return vector3(values, problem, name) if has_length(values, 3, name) else None


def optional_vector4(values: Any, problem: str, name: str) -> tuple[float, float, float, float] | None:
    """Four finite numbers, or None as from `optional_vector3`."""
    return vector4(values, problem, name) if has_length(values, 4, name) else None


def optional_rotation(values: Any, problem: str, name: str) -> Quaternion | None:
    """A quaternion (x, y, z, w) that can be normalised, or None as from `optional_vector3`."""
    return rotation(values, problem, name) if has_length(values, 4, name) else None


def optional_pose(position: Any, orientation: Any, problem: str, prefix: str) -> Pose:
    """A pose from two arguments, whose names begin with `prefix`; the identity for those that are None."""
    if position is None and orientation is None:
        return IDENTITY
    place = optional_vector3(position, problem, f"{prefix}Position") or IDENTITY.position
    turn = optional_rotation(orientation, problem, f"{prefix}Orientation")
    if turn is None:
        return Pose(place)
    return Pose(place, quaternion_from_matrix(rotation_matrix(turn)))


def has_length(values: Any, count: int, name: str) -> bool:
    """Whether an argument was given and has `count` items; warns if it was given without these."""
    if values is None:
        return False
    try:
        if len(values) == count:
            return True
    except TypeError:
        pass
    warn_once(f"{name} is not a sequence of {count} numbers, so its default is used")
    return False
