"""The call that loaded a body, for `saveWorld`."""

from __future__ import annotations

from collections.abc import Mapping


class FileLoad:
    """A call that loaded `count` bodies from a file, with its arguments except the file, by name.

    `takes_pose`: whether the function has arguments for the pose of the body.
    """

    __slots__ = ("arguments", "count", "function", "takes_pose")

    def __init__(
        self, function: str, arguments: Mapping[str, float | str], takes_pose: bool = False, count: int = 1
    ) -> None:
        self.function = function
        self.arguments = arguments
        self.takes_pose = takes_pose
        self.count = count


class Origin:
    """Origin of a body: it is number `index`, from 0, of the bodies loaded by a call."""

    __slots__ = ("index", "load")

    def __init__(self, load: FileLoad, index: int = 0) -> None:
        self.load = load
        self.index = index
