"""The bodies of a world by their numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.scene.body import Body


class Bodies(dict[int, "Body"]):
    """A dictionary whose `KeyError` says which bodies there are."""

    def __missing__(self, number: int) -> Body:
        there = f"there are {', '.join(map(str, self))}" if self else "there are none"
        raise KeyError(f"there is no body {number!r}; {there}")
