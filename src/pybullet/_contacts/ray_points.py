"""The start and end points of many rays as arrays."""

from __future__ import annotations

from itertools import chain, islice
from struct import error as StructError
from struct import pack
from typing import Any

import numpy as np

from carom.description.pose import Pose
from carom.description.transform import rotation_matrix
from carom.native.products import product
from pybullet._calls.arguments import MAX_MAGNITUDE, sequence, vector3
from pybullet._calls.errors import fail


def ray_points(values: Any, problem: str, name: str) -> np.ndarray:
    """Points as an array of shape (count, 3); raises `pybullet.error` for other values."""
    items = values if isinstance(values, np.ndarray) else sequence(values, problem, name)
    if isinstance(items, np.ndarray) and not items.ndim:
        fail(problem, f"{name} is {values!r}.")
    try:
        if isinstance(items, np.ndarray):
            points = np.asarray(items, dtype=float).reshape(len(items), -1)
        elif set(map(len, items)) == {3}:
            # Four times as fast as `np.asarray`, which has to find the depth of the nested lists.
            count = 3 * len(items)
            flat = islice(chain.from_iterable(items), count)
            points = np.frombuffer(pack(f"{count}d", *flat)).reshape(-1, 3)
        else:
            points = np.empty((len(items), 0))
    except (TypeError, ValueError, OverflowError, StructError):
        points = np.empty((len(items), 0))
    if len(items) and (points.shape[1] != 3 or not np.isfinite(points).all()):
        each = [vector3(item, problem, f"{name}[{number}]") for number, item in enumerate(items)]
        return np.array(each)
    if len(items) and np.abs(points).max() > MAX_MAGNITUDE:
        fail(problem, f"{name} holds a number greater than {MAX_MAGNITUDE:g}.")
    return points


def in_world(points: np.ndarray, frame: Pose) -> np.ndarray:
    """Converts points from a frame to the world frame; both arrays have shape (count, 3)."""
    return product(points, np.array(rotation_matrix(frame.orientation)).T) + frame.position
