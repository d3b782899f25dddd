"""Blocks of memory that are copied by one native call, again and again."""

from __future__ import annotations

import ctypes
from collections.abc import Iterable
from functools import cache
from math import prod
from typing import Any

import numpy as np

from carom.layouts.table_rows import Block, WorldBlock
from carom.native.arrays import c_array


class BlockCopies:
    """Copies of arrays to others of the same type, valid until one of them is replaced.

    Of arrays of different length along an axis, as much is copied as there is room for. The call holds the
    GIL: no signal handler runs between the first array and the last.
    """

    def __init__(self, pairs: Iterable[tuple[np.ndarray, np.ndarray]]) -> None:
        """Prepare copies of arrays (source, target) whose entries are next to each other."""
        self._kept = list(pairs)
        blocks = [block for pair in self._kept for block in _blocks_of(*pair)]
        self._blocks = c_array(Block, len(blocks), blocks)
        self._address, self._count = ctypes.addressof(self._blocks), len(blocks)
        self._copy = _function()

    def __call__(self) -> None:
        """Copy all of them."""
        self._copy(self._address, self._count)


def copy_worlds(
    pairs: Iterable[tuple[np.ndarray, np.ndarray, int]], sources: np.ndarray, targets: np.ndarray
) -> None:
    """Copy what some worlds have in arrays (source, target) to other worlds, by one call.

    Args:
        pairs: Arrays of the same type whose first axis is that of worlds, whose entries of one world are next
            to each other, and how many rows of their second axis are copied; 0 for all they have.
        sources: Places of worlds in the first arrays, (n,).
        targets: Places in the others.
    """
    blocks: list[tuple[int, int, int, int, int]] = []
    for source, target, rows in pairs:
        for array in (source, target):
            if len(array) and not array[0].flags.c_contiguous:
                raise ValueError("entries of a world are not next to each other")
        size = target.dtype.itemsize * prod((rows, *target.shape[2:]) if rows else target.shape[1:])
        if source.dtype != target.dtype:
            raise ValueError("arrays of different types cannot be copied as blocks")
        blocks.append((source.ctypes.data, target.ctypes.data, source.strides[0], target.strides[0], size))
    records = c_array(WorldBlock, len(blocks), blocks)
    numbers = [np.ascontiguousarray(it, dtype=np.int64) for it in (sources, targets)]
    _world_function()(
        ctypes.addressof(records), len(blocks), *(it.ctypes.data for it in numbers), len(numbers[0])
    )


def _blocks_of(source: np.ndarray, target: np.ndarray) -> list[tuple[int, int, int]]:
    """Addresses of source and target and number of bytes of blocks that are each in one piece."""
    if source.dtype != target.dtype or source.ndim != target.ndim:
        raise ValueError("arrays of different types cannot be copied as blocks")
    both = (source, target)
    shape = tuple(map(min, source.shape, target.shape))
    if source.ndim == 0 or not all(shape):
        return []
    if all(it.flags.c_contiguous and it.shape[1:] == shape[1:] for it in both):
        size = source.itemsize * prod(shape)
        return [(source.ctypes.data, target.ctypes.data, size)]
    return [block for k in range(shape[0]) for block in _blocks_of(source[k], target[k])]


@cache
def _function() -> Any:
    from carom.native.library import library

    copy = ctypes.PYFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int64)
    return copy(("carom_copy_blocks", library().symbols))


@cache
def _world_function() -> Any:
    from carom.native.library import library

    pointer = ctypes.c_void_p
    copy = ctypes.PYFUNCTYPE(None, pointer, ctypes.c_int64, pointer, pointer, ctypes.c_int64)
    return copy(("carom_copy_worlds", library().symbols))
