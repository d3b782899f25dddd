"""The bodies of a world, or of many, by their numbers."""

from __future__ import annotations

from typing import TypeVar

from carom.scene.named import HasName

_Body = TypeVar("_Body", bound=HasName)


class Bodies(dict[int, _Body]):
    """A dictionary whose `KeyError` says which bodies there are."""

    def __missing__(self, number: int) -> _Body:
        there = ", ".join(f"{known} ({body.name!r})" for known, body in self.items())
        raise KeyError(f"there is no body {number!r}; the world has {there or 'none'}")
