"""Descriptions of bodies made from shapes: the same object for the same arguments, so it is made once."""

from __future__ import annotations

import pickle
from collections.abc import Iterable
from io import BytesIO
from typing import Any

import numpy as np

from carom.description import Robot
from pybullet._clients.shape_registry import CollisionShape, KeptDescription, ShapeRegistry

# Number of descriptions that a client keeps.
_KEPT = 64


class _NotNumbers(Exception):
    """Arguments are other than numbers, sequences and arrays."""


class _Values(pickle.Pickler):
    """Writes numbers, sequences and arrays as their values; runs no code of the user."""

    def reducer_override(self, value: Any) -> Any:
        if type(value) is np.ndarray:
            return tuple, (value.tolist(),)
        if isinstance(value, np.generic) and type(value).__module__ == "numpy":
            number = value.item()
            return type(number), (number,)
        if isinstance(value, type):
            return NotImplemented
        raise _NotNumbers


def key_of(arguments: tuple[Any, ...]) -> bytes | None:
    """What tells arguments apart, to the last bit of each number; None if these are of unusual types."""
    written = BytesIO()
    writer = _Values(written, pickle.HIGHEST_PROTOCOL)
    # Equal items are written alike, whether or not they are the same object.
    writer.fast = True
    try:
        writer.dump(arguments)
    except (_NotNumbers, pickle.PicklingError, ValueError, RecursionError):
        return None
    return written.getvalue()


def kept_description(shapes: ShapeRegistry, key: bytes | None) -> KeptDescription | None:
    """The description kept under a key, if its shapes are still the same."""
    kept = None if key is None else shapes.described.get(key)
    # Numbers of removed shapes are given again, and heights of height fields replaced.
    if kept is None or not (
        all(_content(shapes.collisions.get(number)) is it for number, it in kept.collisions.items())
        and all(shapes.visuals.get(number) is it for number, it in kept.visuals.items())
    ):
        return None
    return kept


def keep_description(
    shapes: ShapeRegistry, key: bytes | None, robot: Robot, collisions: Iterable[int], visuals: Iterable[int]
) -> KeptDescription:
    """Keep a description made from shapes, unless one of those is missing, of which each call warns."""
    kept = KeptDescription(
        robot,
        {number: _content(shapes.collisions.get(number)) for number in collisions},
        {number: shapes.visuals.get(number) for number in visuals},
    )
    missing = any(
        it is None and number >= 0 for used in (kept.collisions, kept.visuals) for number, it in used.items()
    )
    if key is not None and not missing:
        shapes.described[key] = kept
        while len(shapes.described) > _KEPT:
            shapes.described.popitem(last=False)
    return kept


def _content(shape: CollisionShape | None) -> Any:
    return None if shape is None else shape.collisions
