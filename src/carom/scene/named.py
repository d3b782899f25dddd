"""A sequence whose items can also be found by name."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fnmatch import fnmatchcase
from typing import Generic, Protocol, SupportsIndex, TypeVar

from carom.closed import Closed


class HasName(Protocol):
    """Interface of items that have a name."""

    @property
    def name(self) -> str:
        """The name."""
        ...


_WILDCARDS = frozenset("*?[")
Item = TypeVar("Item", bound=HasName)


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

    def __getitem__(self, key: int | str) -> Item:
        """The item with an index or a name.

        Raises:
            IndexError: There is no such index. Negative ones count from the end; of links -1 is the base.
            KeyError: There is no such name.
            TypeError: It is neither.
        """
        if isinstance(key, str):
            if key not in self._by_name:
                raise KeyError(f"no {self._kind} is called {key!r}; there are {', '.join(self.names)}")
            return self._by_name[key]
        if type(key) is not int:
            # A look at a protocol takes microseconds.
            if not isinstance(key, SupportsIndex):
                raise TypeError(f"a {self._kind} is found by its number or its name, not by {key!r}")
            key = key.__index__()
        from_end = key < 0 and self._first == 0
        place = key + len(self._items) if from_end else key - self._first
        if not 0 <= place < len(self._items):
            last = self._first + len(self._items) - 1
            base = "" if self._first == 0 else "; -1 is the base"
            raise IndexError(f"{self._kind} {key} is out of range: indices are {self._first} to {last}{base}")
        return self._items[place]

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


class Grouped(Named[Item]):
    """Items of which several are a group: by a slice, a pattern of names, or several numbers and names."""

    def _sought(self, key: int | str | slice | Sequence[int | str]) -> Item | list[Item]:
        """An item by its number or its name, or those of a group.

        A name with one of the characters `*?[` which no item has is a pattern. Slices are of the items that
        are numbered from 0 on.

        Raises:
            IndexError: There is no item in this place; negative numbers count from the end.
            KeyError: None has this name, or a name that fits the pattern.
            ValueError: One is named twice.
            TypeError: It is nothing of this kind.
        """
        if isinstance(key, int):
            return Named.__getitem__(self, key)
        if isinstance(key, slice):
            return self._items[max(0, -self._first) :][key]
        if isinstance(key, str):
            return self._fitting(key) if self._is_pattern(key) else Named.__getitem__(self, key)
        # Arrays have `__index__` as well.
        if isinstance(key, SupportsIndex) and not hasattr(key, "__len__"):
            return Named.__getitem__(self, key.__index__())
        if not isinstance(key, Iterable):
            raise TypeError(
                f"a {self._kind} is found by its number or its name, not by {key!r}; several are found by a "
                "slice, a pattern of names, or a list"
            )
        chosen: list[Item] = []
        for part in key:
            chosen += self._fitting(part) if self._is_pattern(part) else [Named.__getitem__(self, part)]
        if len({id(item) for item in chosen}) < len(chosen):
            raise ValueError(f"{self._kind}s are named twice: {', '.join(item.name for item in chosen)}")
        return chosen

    def _is_pattern(self, key: int | str) -> bool:
        return isinstance(key, str) and key not in self and not _WILDCARDS.isdisjoint(key)

    def _fitting(self, pattern: int | str) -> list[Item]:
        fitting = [item for item in self._items if fnmatchcase(item.name, str(pattern))]
        if not fitting:
            raise KeyError(f"no {self._kind} has a name like {pattern!r}; there are {', '.join(self.names)}")
        return fitting
