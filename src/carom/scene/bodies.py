"""The bodies of a world, or of many, by their numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Protocol, SupportsIndex, TypeVar


class _HasNameAndNumber(Protocol):
    """Interface of bodies."""

    @property
    def id(self) -> int:
        """Its number."""
        ...

    @property
    def name(self) -> str:
        """Its name."""
        ...


_Body = TypeVar("_Body", bound=_HasNameAndNumber)


class Bodies(dict[int, _Body]):
    """Bodies in the order they were added, by number or name; `KeyError` says which there are.

    A dictionary by number whose iterator gives the bodies themselves, as that of a `World` does; its numbers
    are `keys()`.
    """

    if TYPE_CHECKING:

        def __getitem__(self, key: int | str | _Body) -> _Body: ...

    def __iter__(self) -> Iterator[_Body]:  # pyright: ignore[reportIncompatibleMethodOverride]
        """The bodies; any of them may be removed meanwhile."""
        return iter([*self.values()])

    def __contains__(self, key: object) -> bool:
        """Whether there is a body of this number or name, or this very one."""
        return self.has(key)

    def __missing__(self, key: Any) -> _Body:
        return self.find(key)

    def find(self, key: Any) -> _Body:
        """A body by its number, its name, or by itself; of several with one name the first.

        Negative numbers count from the end of those that are there, in the order they were added.

        Raises:
            KeyError: There is no such body, or it is one of another world.
        """
        if isinstance(key, str):
            found = next((body for body in self.values() if body.name == key), None)
        elif isinstance(key, SupportsIndex):
            number = key.__index__()
            found = self.get(number)
            if found is None and -len(self) <= number < 0:
                found = [*self.values()][number]
        else:
            found = key if self.get(getattr(key, "id", -1)) is key else None
        if found is None:
            there = ", ".join(f"{known} ({body.name!r})" for known, body in self.items())
            raise KeyError(f"there is no body {key!r}; the world has {there or 'none'}")
        return found

    def has(self, key: Any) -> bool:
        """Whether `find` finds a body; a negative number is that of none."""
        if isinstance(key, SupportsIndex) and key.__index__() < 0:
            return False
        try:
            self.find(key)
        except KeyError:
            return False
        return True
