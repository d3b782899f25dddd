"""A sequence whose items can also be found by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import Any, Generic, Protocol, SupportsIndex, TypeVar, overload

from carom.closed import Closed


class HasName(Protocol):
    """Interface of items that have a name."""

    @property
    def name(self) -> str:
        """The name."""
        ...


_WILDCARDS = frozenset("*?[")
Item = TypeVar("Item", bound=HasName)
Group = TypeVar("Group")


class Named(Closed, Generic[Item]):
    """Items by index or by name."""

    def __init__(self, kind: str, items: Sequence[Item], first: int = 0) -> None:
        """Number the items from `first` on; if several have the same name, the first is found.

        `kind` is what messages call an item.
        """
        self._kind = kind
        self._items = list(items)
        self._first = first
        self._by_name = {item.name: item for item in reversed(self._items)}
        self._close()

    def __repr__(self) -> str:
        return f"<{self._kind}: {', '.join(map(repr, self.names)) or 'none'}>"

    @overload
    def __getitem__(self, key: int | str | HasName) -> Item: ...
    @overload
    def __getitem__(self, key: slice | Sequence[int | str]) -> Sequence[Item]: ...
    def __getitem__(self, key: int | str | HasName | slice | Sequence[int | str]) -> Item | Sequence[Item]:
        """The item with an index or a name; several by a slice, a pattern of names, or a list of these.

        A handle stands for the item of its index and name, also that of another world. A name with one of the
        characters `*?[` which no item has is a pattern. Type checkers take it for a name: `[["finger*"]]`
        finds the same.

        Raises:
            IndexError: There is no such index. Negative ones count from the end; of links -1 is the base.
            KeyError: There is no such name, or none that fits the pattern.
            ValueError: An item is named twice.
            TypeError: It is nothing of this kind.
        """
        # The usual cases by themselves.
        if type(key) is int:
            if key >= 0 and not self._first:
                try:
                    return self._items[key]
                except IndexError:
                    pass
        elif type(key) is str:
            found = self._by_name.get(key)
            if found is not None:
                return found
        return self._sought(key)

    def __len__(self) -> int:
        return len(self._items)

    def __iter__(self) -> Iterator[Item]:
        return iter(self._items)

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    @property
    def names(self) -> list[str]:
        """All names, in order."""
        return [item.name for item in self._items]

    def _sought(self, key: Any) -> Item | list[Item]:
        """An item, or several in a list, as `__getitem__` finds them. Slices leave out a base."""
        if isinstance(key, int):
            return self._one(key)
        if isinstance(key, slice):
            return self._items[max(0, -self._first) :][key]
        if isinstance(key, str):
            return self._fitting(key) if self._is_pattern(key) else self._one(key)
        if self._is_one(key):
            return self._one(key)
        if not isinstance(key, Iterable):
            raise TypeError(self._kinds_of_keys(key))
        chosen: list[Item] = []
        parts: Iterable[Any] = key
        for part in parts:
            chosen += self._fitting(part) if self._is_pattern(part) else [self._one(part)]
        if len({id(item) for item in chosen}) < len(chosen):
            raise ValueError(f"{self._kind}s are named twice: {', '.join(item.name for item in chosen)}")
        return chosen

    def _one(self, key: Any) -> Item:
        """An item by its number, its name or a handle."""
        if isinstance(key, str):
            if key not in self._by_name:
                raise KeyError(f"no {self._kind} is called {key!r}; there are {', '.join(self.names)}")
            return self._by_name[key]
        if type(key) is not int:
            # A look at a protocol takes microseconds.
            if not isinstance(key, SupportsIndex):
                return self._like(key)
            key = key.__index__()
        from_end = key < 0 and self._first == 0
        place = key + len(self._items) if from_end else key - self._first
        if not 0 <= place < len(self._items):
            last = self._first + len(self._items) - 1
            base = "" if self._first == 0 else "; -1 is the base"
            raise IndexError(f"{self._kind} {key} is out of range: indices are {self._first} to {last}{base}")
        return self._items[place]

    def _like(self, handle: Any) -> Item:
        """The item that a handle stands for: one of the same name, and of the same index where it has one."""
        name = getattr(handle, "name", None)
        if not isinstance(name, str):
            raise TypeError(self._kinds_of_keys(handle))
        index = getattr(handle, "index", None)
        for item in self._items:
            if item.name == name and getattr(item, "index", None) == index:
                return item
        raise KeyError(f"{handle!r} is not among these; there are {', '.join(self.names)}")

    def _kinds_of_keys(self, key: object) -> str:
        article = "an" if self._kind[0] in "aeiou" else "a"
        return (
            f"{article} {self._kind} is found by its number, its name or its handle, not by {key!r}; several "
            "are found by a slice, a pattern of names, or a list"
        )

    def _is_one(self, key: Any) -> bool:
        """Whether it can be a number or a handle; arrays have `__index__` as well, and lists an `index`."""
        if hasattr(key, "__len__"):
            return False
        return isinstance(key, SupportsIndex) or isinstance(getattr(key, "name", None), str)

    def _is_pattern(self, key: Any) -> bool:
        return isinstance(key, str) and key not in self._by_name and not _WILDCARDS.isdisjoint(key)

    def _fitting(self, pattern: Any) -> list[Item]:
        fitting = [item for item in self._items if fnmatchcase(item.name, str(pattern))]
        if not fitting:
            raise KeyError(f"no {self._kind} has a name like {pattern!r}; there are {', '.join(self.names)}")
        return fitting


class Grouped(Named[Item], Generic[Item, Group]):
    """Items of which several are a group with arrays of its own, and not a list."""

    @overload
    def __getitem__(self, key: int | str | HasName) -> Item: ...
    @overload
    def __getitem__(self, key: slice | Sequence[int | str]) -> Group: ...
    def __getitem__(  # pyright: ignore[reportIncompatibleMethodOverride]
        self, key: int | str | HasName | slice | Sequence[int | str]
    ) -> Item | Group:
        """One by its number or its name; a group by a slice, a pattern of names, or by several of these.

        A name with one of the characters `*?[` which none has is a pattern. Type checkers take it for a name:
        `[["finger*"]]` is the same group.

        Raises:
            IndexError: There is no such number; negative ones count from the end, but of all links -1 is the
                base.
            KeyError: There is no such name, or none that fits the pattern.
            ValueError: One is named twice.
        """
        # The usual case by itself.
        found = self._by_name.get(key) if type(key) is str else None
        if found is not None:
            return found
        if type(key) is int:
            return self._one(key)
        found = self._sought(key)
        return self._group(found) if isinstance(found, list) else found

    def _group(self, items: list[Item]) -> Group:
        """A group of these."""
        raise NotImplementedError
