"""Changes that are prepared beside what they change, and then made by one native call.

While a change is prepared, only the preparation is written to. So whatever interrupts that (an exception, a
signal handler, a trace function, another thread) finds everything as it was, and a change that is given up
has not happened. `Change.commit` runs no line of Python in the middle; after it everything is as it will be.
"""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from struct import Struct
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

from carom.native.builtins import new_builtin
from carom.native.uninterrupted import uninterrupted

if TYPE_CHECKING:
    # `import pybullet` comes here, and NumPy waits until there is a world.
    import numpy as np
    import numpy.typing as npt

T = TypeVar("T")

_MISSING = object()
# A part of changes that is empty.
_NO_RECORDS = b""
_ZERO = ctypes.c_int64(0)
_BLOCK = Struct("=QQq")
packed_block = _BLOCK.pack
"""A `layouts.table_rows.Block` of memory to be copied: addresses of source and target, and its size."""

# `layouts.table_rows.RowCut` and `KernelRun`.
_CUT = Struct("=4Q")
_RUN = Struct("=4Qq")
packed_run = _RUN.pack
"""A `layouts.table_rows.KernelRun`: addresses of a kernel, its arguments and the tree among these; a tree."""
# Ctrl-C may come while Python makes a change: maximum number of attempts to complete it.
_PATIENCE = 100

Attributes = dict[int, tuple[object, dict[str, Any]]]
"""Attributes that change, by object: it and its attributes, by its `id`."""


class Outdated(Exception):
    """Another change has been made since a change was begun, which has not been made: begin again."""


class Table(Protocol):
    """What can grow: `carom.native.tables.ArrayTable`."""

    def lacks(self, needed: Mapping[str, int]) -> bool:
        """Whether there is no room for `needed` rows on one of the axes."""
        ...

    def grow(self, change: Change, needed: Mapping[str, int]) -> dict[str, np.ndarray]:
        """Make room for rows by axis with a change; the new arrays by name."""
        ...


class Change:
    """A change of objects and of memory, which is made as a whole or not at all.

    Each method notes a part of it. What is noted for an attribute replaces what was noted for it before, and
    `get` reads it; dictionaries and lists that change in place are read as they are before the change.

    Args:
        renew: Notes what else changes when tables grow, see `make_room`.
        begun: `changes_made` before it was prepared, as in `first_change`, if it has to be the first one
            after that: it relies on places or numbers that any other may change. -1 in a section, where
            nothing comes in between.
    """

    __slots__ = (
        "_attributes",
        "_begun",
        "_blocks",
        "_contents",
        "_copies",
        "_cuts",
        "_items",
        "_kept",
        "_more",
        "_renew",
        "_runs",
        "_writes",
    )

    def __init__(self, renew: Callable[[Change], None] | None = None, *, begun: int = -1) -> None:
        self._renew = renew
        self._begun = begun
        self._attributes: Attributes = {}
        # Dictionaries, keys and values, each in turn; likewise dictionaries, contents and present contents,
        # lists and items for their ends, and arrays and what is written to them.
        self._items: list[Any] = []
        self._contents: list[dict[Any, Any]] = []
        self._more: list[list[Any]] = []
        self._writes: list[Any] = []
        # Records, one after the other.
        self._cuts = self._blocks = self._runs = _NO_RECORDS
        self._copies: dict[int, _Copies] | None = None
        # Memory that the records point to.
        self._kept: list[Any] = []

    def set(self, owner: object, name: str, value: object) -> None:
        """Set an attribute, which its object has in a dictionary or a slot: no code of Python runs for it."""
        noted = self._attributes.get(id(owner))
        if noted is None:
            self._attributes[id(owner)] = owner, {name: value}
        else:
            noted[1][name] = value

    def set_all(self, owner: object, /, **values: object) -> None:
        """Set several attributes of an object."""
        noted = self._attributes.get(id(owner))
        if noted is None:
            self._attributes[id(owner)] = owner, values
        else:
            noted[1].update(values)

    def get(self, owner: object, name: str) -> Any:
        """An attribute as it will be."""
        noted = self._attributes.get(id(owner))
        if noted is None or name not in noted[1]:
            return getattr(owner, name)
        return noted[1][name]

    def put(self, dictionary: dict[Any, Any], key: int | str, value: object) -> None:
        """Set an item of a dictionary."""
        self._items += dictionary, key, value

    def put_all(self, dictionary: dict[Any, Any], values: Mapping[Any, object]) -> None:
        """Set several items of a dictionary."""
        for key, value in values.items():
            self._items += dictionary, key, value

    def drop(self, dictionary: dict[Any, Any], key: int | str) -> None:
        """Remove an item of a dictionary, if it is there."""
        self._items += dictionary, key, _MISSING

    def refill(self, dictionary: dict[Any, Any], content: dict[Any, Any]) -> None:
        """Replace all items of a dictionary, which stays the same object."""
        self._contents += dictionary, content, dictionary.copy()

    def content(self, dictionary: dict[Any, T]) -> dict[Any, T]:
        """The items of a dictionary as they will be, if they are refilled or some of them are set."""
        for it, content, _ in _in_turn(self._contents, 3):
            if it is dictionary:
                return content
        noted = [(key, value) for it, key, value in _in_turn(self._items, 3) if it is dictionary]
        if not noted:
            return dictionary
        content = {**dictionary, **dict(noted)}
        return {key: value for key, value in content.items() if value is not _MISSING}

    def arrays(self, arrays: Mapping[str, np.ndarray]) -> Mapping[str, np.ndarray]:
        """Copies of arrays, made when they are asked for; what they contain then is written to the arrays.

        The same copies are returned each time.
        """
        if self._copies is None:
            self._copies = {}
        copies = self._copies.get(id(arrays))
        if copies is None:
            copies = self._copies[id(arrays)] = _Copies(arrays)
        return copies

    def extend(self, items: list[T], more: list[T]) -> None:
        """Append items to a list."""
        self._more += items, more

    def write(self, target: np.ndarray, values: npt.ArrayLike, *, lasting: bool = False) -> None:
        """Write to an array, or to a view of a part of it; the values are broadcast to its shape.

        A `lasting` array of values stays as it is until the change is made, and need not be copied.
        """
        source: Any = values
        if not (
            lasting
            and source.shape == target.shape
            and source.dtype == target.dtype
            and source.flags.c_contiguous
        ):
            source = target.copy()
            source[...] = values
        self._writes += target, source

    def write_numbers(
        self, target: np.ndarray | memoryview[Any], values: Iterable[float], code: str = "d"
    ) -> None:
        """Write as many numbers to memory: what `write` does, in less time where there are few.

        They are of the type that `code` stands for in the module `array`, by default doubles.
        """
        self._writes += target, array(code, values)

    def copy_blocks(self, blocks: bytes, kept: object) -> None:
        """Copy blocks of memory, given as records (`layouts.table_rows.Block`), which point into `kept`."""
        self._blocks += blocks
        self._kept.append(kept)

    def cut(self, table: int, first: bytes, count: bytes, used: bytes, kept: object) -> None:
        """Take rows out of tables, before memory is written; see `RowChanges.cut`."""
        numbers = bytearray(first + count + used)
        start, size = ctypes.addressof(ctypes.c_char.from_buffer(numbers)), len(first)
        self._cuts += _CUT.pack(table, start, start + size, start + 2 * size)
        self._kept += numbers, kept

    def make_room(self, tables: Sequence[Table], needed: Mapping[str, int]) -> None:
        """Let tables grow at once, before this change: that is one of its own, and rows stay as they are."""
        if not any(table.lacks(needed) for table in tables):
            return
        growth = Change()
        for table in tables:
            table.grow(growth, needed)
        if self._renew is not None:
            self._renew(growth)
        growth.commit()

    def run(self, addresses: Sequence[int], tree: int, kept: object) -> None:
        """Run a kernel on a tree after memory is written; see `TreeLaunch.addresses`."""
        self.run_record(packed_run(*addresses, tree), kept)

    def run_record(self, record: bytes, kept: object) -> None:
        """The same with a packed record, or with several, one after the other."""
        self._runs += record
        self._kept.append(kept)

    def commit(self) -> None:
        """Make the change, once; if memory is short, nothing of it.

        Raises:
            Outdated: It is not the first one since it was begun.
            ValueError: What is to be written has another size than the place for it; nothing has changed.
        """
        if self._copies is not None:
            for copies in self._copies.values():
                for name, copy in copies.items():
                    self._writes += copies.originals[name], copy
        made = (_Maker.make or _Maker.find())(
            self._attributes,
            self._items,
            self._contents,
            self._more,
            self._writes,
            self._cuts,
            self._blocks,
            self._runs,
            self._begun,
        )
        if made is not _MISSING:
            raise Outdated


def changes_made() -> int:
    """How many changes have been made so far, and steps of worlds."""
    return _Maker.made.value


def blank(
    record: ctypes.Structure, path: str, value: ctypes.c_int64 | ctypes.c_int32 | ctypes.c_double = _ZERO
) -> bytes:
    """The block that writes a value, 0 by default, to a field of a record; its path has points.

    The value has to be kept until it is written.
    """
    *outer, name = path.split(".")
    holder: Any = record
    for step in outer:
        holder = getattr(holder, step)
    field = getattr(type(holder), name)
    return packed_block(ctypes.addressof(value), ctypes.addressof(holder) + field.offset, field.size)


def first_change() -> Change:
    """A change that has to be the first one from now on: ask for it before what it relies on is looked up."""
    return Change(begun=changes_made())


class _Copies(dict[str, "np.ndarray"]):
    """Copies of arrays by their names, made when they are asked for."""

    def __init__(self, originals: Mapping[str, np.ndarray]) -> None:
        super().__init__()
        self.originals = originals

    def __missing__(self, name: str) -> np.ndarray:
        copy = self[name] = self.originals[name].copy()
        return copy


def _in_turn(items: list[Any], count: int) -> list[tuple[Any, ...]]:
    """Items of a list, so many at a time."""
    return list(zip(*[iter(items)] * count, strict=True))


@cache
def _commit() -> Any:
    """The native function that makes changes; None where Python does."""
    # This loads the library.
    from carom.native.host import host

    return None if host is None else new_builtin("commit", host.symbols.carom_commit, _MISSING)


class _Maker:
    """What makes changes.

    Attributes:
        make: The function that does, once it has been found.
        made: How many it has made.
    """

    make: ClassVar[Any] = None
    made: ClassVar[ctypes.c_int64] = ctypes.c_int64(0)

    @classmethod
    def find(cls) -> Any:
        """Find it when the first change is made: the library has been loaded then."""
        cls.make = _commit() or _make
        if cls.make is not _make:
            cls.made = ctypes.c_int64.in_dll(_symbols(), "carom_changes_made")
        return cls.make


def _symbols() -> Any:
    from carom.native.library import library

    return library().symbols


def _make(
    attributes: Attributes,
    items: list[Any],
    contents: list[dict[Any, Any]],
    more: list[list[Any]],
    writes: list[Any],
    cuts: bytes,
    blocks: bytes,
    runs: bytes,
    begun: int,
) -> object:
    """Make a change in Python: in a section, and if an exception comes in the middle, first to the end."""
    if any(memoryview(target).nbytes != memoryview(source).nbytes for target, source in _in_turn(writes, 2)):
        raise ValueError("too few or too many numbers for what they are written to")
    ends: dict[int, int] = {}
    extensions = []
    for extended, added in _in_turn(more, 2):
        start = ends.get(id(extended), len(extended))
        extensions.append((extended, added, start))
        ends[id(extended)] = start + len(added)
    # Old values are dropped at the end, so that no finalizer runs in the middle.
    kept = [getattr(owner, name, None) for owner, values in attributes.values() for name in values]
    kept += [dictionary.get(key) for dictionary, key, _ in _in_turn(items, 3)]
    error: BaseException | None = None
    with uninterrupted:
        if begun not in (-1, changes_made()):
            return begun
        _Maker.made.value += 1
        for _ in range(_PATIENCE):
            try:
                for owner, values in attributes.values():
                    for name, value in values.items():
                        object.__setattr__(owner, name, value)
                for dictionary, key, value in _in_turn(items, 3):
                    if value is _MISSING:
                        dictionary.pop(key, None)
                    else:
                        dictionary[key] = value
                for dictionary, content, _ in _in_turn(contents, 3):
                    dictionary.clear()
                    dictionary.update(content)
                for extended, added, start in extensions:
                    extended[start:] = added
                break
            except BaseException as problem:
                error = problem
        if cuts:
            _symbols().carom_cut_rows(cuts, ctypes.c_int64(len(cuts) // _CUT.size))
        for target, source in _in_turn(writes, 2):
            if type(target) is memoryview:
                target.cast("B")[:] = memoryview(source).cast("B")
            else:
                target[...] = source
        for source, target, size in _BLOCK.iter_unpack(blocks):
            ctypes.memmove(target, source, size)
        if runs:
            _symbols().carom_launch(runs, ctypes.c_int64(len(runs) // _RUN.size))
    kept.clear()
    if error is not None:
        raise error
    return _MISSING
