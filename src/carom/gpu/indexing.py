"""Array indexing: an index as a strided part of the memory, and a list of indices along one axis of it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np


class Part(NamedTuple):
    """A part of an array: a strided view, and indices of the entries that are picked along one of its axes.

    Attributes:
        offset: Offset of the view [bytes].
        shape: Shape of the view, before entries are picked.
        strides: Strides of the view [bytes].
        axis: The axis along which entries are picked; None if there is none.
        picks: Indices of the picked entries along this axis, (n,).
    """

    offset: int
    shape: tuple[int, ...]
    strides: tuple[int, ...]
    axis: int | None
    picks: np.ndarray | None

    @property
    def picked_shape(self) -> tuple[int, ...]:
        """Shape after entries have been picked."""
        if self.axis is None or self.picks is None:
            return self.shape
        return (*self.shape[: self.axis], len(self.picks), *self.shape[self.axis + 1 :])


def part_of(shape: tuple[int, ...], strides: tuple[int, ...], key: Any) -> Part:
    """The part that an index selects: integers, slices, an ellipsis, and one list of integers or mask.

    Strides are in bytes.

    Raises:
        IndexError: The index has more axes than the array, is out of range, or picks along several axes.
    """
    offset, axis, picks = 0, None, None
    kept_shape: list[int] = []
    kept_strides: list[int] = []
    for length, stride, index in zip(shape, strides, _whole_key(key, len(shape)), strict=True):
        if isinstance(index, slice):
            first, end, by = index.indices(length)
            offset += first * stride
            kept_shape.append(len(range(first, end, by)))
            kept_strides.append(by * stride)
        elif isinstance(index, int | np.integer):
            place = int(index) + length * (index < 0)
            if not 0 <= place < length:
                raise IndexError(f"index {index} is out of range for an axis of {length}")
            offset += place * stride
        else:
            if axis is not None:
                raise IndexError("only one axis can be indexed by a list of integers or a mask")
            axis, picks = len(kept_shape), _numbers(index, length)
            kept_shape.append(length)
            kept_strides.append(stride)
    return Part(offset, tuple(kept_shape), tuple(kept_strides), axis, picks)


def _whole_key(key: Any, axes: int) -> list[Any]:
    """An index with an entry for each axis."""
    keys = list(key) if isinstance(key, tuple) else [key]
    places = [place for place, index in enumerate(keys) if index is Ellipsis]
    missing = axes - (len(keys) - len(places))
    if missing < 0 or len(places) > 1:
        raise IndexError(f"too many indices for an array of {axes} axes")
    place = places[0] if places else len(keys)
    return [*keys[:place], *[slice(None)] * missing, *keys[place + 1 :]]


def _numbers(index: Any, length: int) -> np.ndarray:
    picks = np.asarray(index)
    if picks.dtype == np.bool_:
        if picks.shape != (length,):
            raise IndexError(f"a mask of shape {picks.shape} does not fit an axis of {length}")
        picks = np.flatnonzero(picks)
    if picks.ndim != 1 or (picks.size and not np.issubdtype(picks.dtype, np.integer)):
        raise IndexError(f"an axis must be indexed by a list of integers or a mask, not {index!r}")
    picks = np.where(picks < 0, picks + length, picks)
    if picks.size and not 0 <= picks.min() <= picks.max() < length:
        raise IndexError(f"an index of the list is out of range for an axis of {length}")
    return picks.astype(np.int32)
