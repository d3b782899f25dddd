"""The call that loaded a body, for `saveWorld`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True, repr=False, eq=False, slots=True)
class FileLoad:
    """A call that loaded `count` bodies from a file, with its arguments except the file, by name.

    `takes_pose`: whether the function has arguments for the pose of the body.
    """

    function: str
    arguments: Mapping[str, float | str]
    takes_pose: bool = False
    count: int = 1


@dataclass(frozen=True, slots=True)
class Origin:
    """Origin of a body: it is number `index`, from 0, of the bodies loaded by a call."""

    load: FileLoad
    index: int = 0
