"""Changes that are prepared beside what they change, and then made by one native call.

While a change is prepared, only the preparation is written to. So whatever interrupts that (an exception, a
signal handler, a trace function, another thread) finds everything as it was, and a change that is given up
has not happened. `Change.commit` runs no line of Python in the middle; after it everything is as it will be.
"""

from __future__ import annotations

import ctypes
import sys
import sysconfig
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache, partial
from struct import Struct
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from carom.native.uninterrupted import uninterrupted

T = TypeVar("T")

_MISSING = object()
_ZERO = ctypes.c_int64(0)
packed_block = Struct("=QQq").pack
"""A `layouts.table_rows.Block` of memory to be copied: addresses of source and target, and its size."""

# `layouts.table_rows.RowCut` and `KernelRun`.
_PACK_CUT, _PACK_RUN = Struct("=4Q").pack, Struct("=4Qq").pack
# Types of prepared records and their numbers: cuts, blocks and runs.
_MEMORY = (ctypes.c_char_p, ctypes.c_int64) * 3
# Ctrl-C may come while Python makes a change: maximum number of attempts to complete it.
_PATIENCE = 100


class Table(Protocol):
    """What can grow: `carom.native.tables.ArrayTable`."""

    def grow(self, change: Change, needed: Mapping[str, int]) -> dict[str, np.ndarray]:
        """Make room for rows by axis with a change; the new arrays by name."""
        ...


class Change:
    """A change of objects and of memory, which is made as a whole or not at all.

    Each method notes a part of it. What is noted for an attribute replaces what was noted for it before, and
    `get` reads it; dictionaries and lists that change in place are read as they are before the change.

    Args:
        renew: Notes what else changes when tables grow, see `make_room`.
    """

    __slots__ = (
        "_attributes",
        "_blocks",
        "_contents",
        "_copies",
        "_cuts",
        "_items",
        "_kept",
        "_more",
        "_others",
        "_renew",
        "_runs",
    )

    def __init__(self, renew: Callable[[Change], None] | None = None) -> None:
        self._renew = renew
        self._attributes: dict[tuple[int, str], tuple[Any, str, Any]] = {}
        self._others: list[tuple[Any, str, Any]] = []
        self._items: list[tuple[dict[Any, Any], Any, Any]] = []
        self._contents: list[tuple[dict[Any, Any], dict[Any, Any]]] = []
        self._more: list[tuple[list[Any], list[Any]]] = []
        self._blocks: list[bytes] = []
        self._copies: dict[int, _Copies] = {}
        self._cuts: list[bytes] = []
        self._runs: list[bytes] = []
        # Memory that these point to.
        self._kept: list[Any] = []

    def set(self, owner: object, name: str, value: object) -> None:
        """Set an attribute, which its object has in a dictionary or a slot: no code of Python runs for it."""
        self._attributes[id(owner), name] = owner, name, value

    def set_each(self, values: Iterable[tuple[object, str, object]]) -> None:
        """Set attributes (object, name, value) that `get` is not asked for: quicker where there are many."""
        self._others += values

    def get(self, owner: object, name: str) -> Any:
        """An attribute as it will be."""
        noted = self._attributes.get((id(owner), name))
        return getattr(owner, name) if noted is None else noted[2]

    def put(self, dictionary: dict[Any, Any], key: int | str, value: object) -> None:
        """Set an item of a dictionary."""
        self._items.append((dictionary, key, value))

    def put_all(self, dictionary: dict[Any, Any], values: Mapping[Any, object]) -> None:
        """Set several items of a dictionary."""
        self._items += [(dictionary, key, value) for key, value in values.items()]

    def drop(self, dictionary: dict[Any, Any], key: int | str) -> None:
        """Remove an item of a dictionary, if it is there."""
        self._items.append((dictionary, key, _MISSING))

    def refill(self, dictionary: dict[Any, Any], content: dict[Any, Any]) -> None:
        """Replace all items of a dictionary, which stays the same object."""
        self._contents.append((dictionary, content))

    def content(self, dictionary: dict[Any, T]) -> dict[Any, T]:
        """The items of a dictionary as they will be, if they are refilled or some of them are set."""
        for it, content in self._contents:
            if it is dictionary:
                return content
        noted = [(key, value) for it, key, value in self._items if it is dictionary]
        if not noted:
            return dictionary
        content = {**dictionary, **dict(noted)}
        return {key: value for key, value in content.items() if value is not _MISSING}

    def arrays(self, arrays: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        """Copies of arrays, made when they are asked for; what they contain then is written to the arrays.

        The same copies are returned each time.
        """
        copies = self._copies.get(id(arrays))
        if copies is None:
            copies = self._copies[id(arrays)] = _Copies(arrays)
        return copies

    def extend(self, items: list[T], more: list[T]) -> None:
        """Append items to a list."""
        self._more.append((items, more))

    def write(self, target: np.ndarray, values: npt.ArrayLike, *, lasting: bool = False) -> None:
        """Write to an array, or to a view of a part of it; the values are broadcast to its shape.

        A `lasting` array of values stays as it is until the change is made, and need not be copied.
        """
        if not target.size:
            return
        shape, dtype = target.shape, target.dtype
        if not (
            lasting
            and isinstance(values, np.ndarray)
            and values.shape == shape
            and values.dtype == dtype
            and values.flags.c_contiguous
        ):
            source = np.empty(shape, dtype)
            source[...] = values
            values = source
        self._kept += values, target
        self._note_blocks(_place(values), target)

    def _note_blocks(self, source: int, target: np.ndarray) -> None:
        """Copy contiguous memory to an array, whose entries need not be next to each other."""
        if target.flags.c_contiguous:
            self._blocks.append(packed_block(source, _place(target), target.nbytes))
            return
        size = target.nbytes // len(target)
        if target.ndim > 1:
            for place in range(len(target)):
                self._note_blocks(source + place * size, target[place])
            return
        address, stride = target.ctypes.data, target.strides[0]
        self._blocks += [
            packed_block(source + place * size, address + place * stride, size)
            for place in range(len(target))
        ]

    def copy_blocks(self, blocks: Sequence[bytes], kept: object) -> None:
        """Copy blocks of memory, given as records (`layouts.table_rows.Block`), which point into `kept`."""
        self._blocks += blocks
        self._kept.append(kept)

    def cut(self, table: int, first: bytes, count: bytes, used: bytes, kept: object) -> None:
        """Take rows out of tables, before memory is written; see `RowChanges.cut`."""
        numbers = bytearray(first + count + used)
        start, size = ctypes.addressof(ctypes.c_char.from_buffer(numbers)), len(first)
        self._cuts.append(_PACK_CUT(table, start, start + size, start + 2 * size))
        self._kept += numbers, kept

    def make_room(self, tables: Sequence[Table], needed: Mapping[str, int]) -> None:
        """Let tables grow at once, before this change: that is one of its own, and rows stay as they are."""
        growth = Change()
        grown = [table.grow(growth, needed) for table in tables]
        if any(grown):
            if self._renew is not None:
                self._renew(growth)
            growth.commit()

    def run(self, addresses: Sequence[int], tree: int, kept: object) -> None:
        """Run a kernel on a tree after memory is written; see `TreeLaunch.addresses`."""
        self._runs.append(_PACK_RUN(*addresses, tree))
        self._kept.append(kept)

    def commit(self) -> None:
        """Make the change, once; if memory is short, nothing of it."""
        for copies in self._copies.values():
            for name, copy in copies.items():
                self.write(copies.originals[name], copy, lasting=True)
        parts = (
            [*self._attributes.values(), *self._others],
            self._items,
            [(dictionary, content, dictionary.copy()) for dictionary, content in self._contents],
            self._more,
        )
        memory: list[Any] = []
        for packed in (self._cuts, self._blocks, self._runs):
            memory += b"".join(packed) if packed else None, len(packed)
        commit = _commit()
        if commit is None:
            _make(*parts, memory)
        else:
            commit(*parts, _MISSING, [_MISSING] * sum(map(len, parts)), *memory)


def blank(record: ctypes.Structure, path: str, value: ctypes.c_int64 = _ZERO) -> bytes:
    """The block that writes a value, 0 by default, to a field of a record; its path has points."""
    *outer, name = path.split(".")
    holder: Any = record
    for step in outer:
        holder = getattr(holder, step)
    field = getattr(type(holder), name)
    return packed_block(ctypes.addressof(value), ctypes.addressof(holder) + field.offset, field.size)


def _place(array: np.ndarray) -> int:
    """Address of an array of contiguous memory, which is not empty; quicker than with NumPy."""
    if array.flags.writeable:
        memory: Any = array
        return ctypes.addressof(ctypes.c_char.from_buffer(memory))
    return array.ctypes.data


class _Copies(dict[str, np.ndarray]):
    """Copies of arrays by their names, made when they are asked for."""

    def __init__(self, originals: Mapping[str, np.ndarray]) -> None:
        super().__init__()
        self.originals = originals

    def __missing__(self, name: str) -> np.ndarray:
        copy = self[name] = self.originals[name].copy()
        return copy


@cache
def _commit() -> Callable[..., None] | None:
    """The native function that makes changes; None where Python does.

    It needs a usual build of CPython: others have other objects, or threads that run in parallel.
    """
    if sys.implementation.name != "cpython" or sysconfig.get_config_var("Py_GIL_DISABLED"):
        return None
    from carom.native.library import library

    symbols = library().symbols
    first = ctypes.c_char.in_dll(symbols, "carom_change_functions")
    names = ctypes.string_at(ctypes.addressof(first)).decode().split()
    addresses = [ctypes.addressof(ctypes.c_char.in_dll(ctypes.pythonapi, name)) for name in names]
    table = (ctypes.c_void_p * len(names))(*addresses)
    of_objects = [ctypes.py_object] * 6
    declared = ctypes.PYFUNCTYPE(ctypes.c_int, ctypes.c_void_p, *of_objects, *_MEMORY)
    return partial(declared(("carom_commit", symbols)), table)


@cache
def _write() -> Callable[..., None]:
    """The native function that writes to memory."""
    from carom.native.library import library

    return ctypes.PYFUNCTYPE(None, *_MEMORY)(("carom_write", library().symbols))


def _make(
    attributes: list[tuple[Any, str, Any]],
    items: list[tuple[dict[Any, Any], Any, Any]],
    contents: list[tuple[dict[Any, Any], dict[Any, Any], dict[Any, Any]]],
    more: list[tuple[list[Any], list[Any]]],
    memory: list[Any],
) -> None:
    """Make a change in Python: in a section, and if an exception comes in the middle, first to the end."""
    ends: dict[int, int] = {}
    starts = []
    for extended, added in more:
        starts.append(ends.get(id(extended), len(extended)))
        ends[id(extended)] = starts[-1] + len(added)
    # Old values are dropped at the end, so that no finalizer runs in the middle.
    kept = [getattr(owner, name, None) for owner, name, _ in attributes]
    kept += [dictionary.get(key) for dictionary, key, _ in items]
    error: BaseException | None = None
    with uninterrupted:
        for _ in range(_PATIENCE):
            try:
                for owner, name, value in attributes:
                    object.__setattr__(owner, name, value)
                for dictionary, key, value in items:
                    if value is _MISSING:
                        dictionary.pop(key, None)
                    else:
                        dictionary[key] = value
                for dictionary, content, _ in contents:
                    dictionary.clear()
                    dictionary.update(content)
                for (extended, added), start in zip(more, starts, strict=True):
                    extended[start:] = added
                break
            except BaseException as problem:
                error = problem
        _write()(*memory)
    kept.clear()
    if error is not None:
        raise error
