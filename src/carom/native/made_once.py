"""Attributes that are made when they are first asked for, by nobody else in the middle of it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Generic, TypeVar

from carom.native.uninterrupted import uninterrupted

Made = TypeVar("Made")


class made_once(Generic[Made]):  # a decorator, as `cached_property` is
    """`functools.cached_property`, but a handler that runs in the middle never makes a second one.

    Launches are shared by all that ask for the same kernel: two who each make arrays and a launch would
    be left with a launch over the arrays of one of them.
    """

    def __init__(self, make: Callable[[Any], Made]) -> None:
        self._make = make
        self.__doc__ = make.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, owner: Any, kind: type | None = None) -> Made:
        made: dict[str, Made] = vars(owner)
        with uninterrupted:
            if self._name not in made:
                made[self._name] = self._make(owner)
        return made[self._name]
