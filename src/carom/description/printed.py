"""How data classes print themselves."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, cast


class Printed:
    """Base of data classes that are made before a first step: prints them as the decorator's method would.

    The decorator compiles a method for each class as it is made, which takes 0.6 million instructions.
    """

    __slots__ = ()

    def __repr__(self) -> str:
        shown = (f"{field.name}={getattr(self, field.name)!r}" for field in fields(cast("Any", self)))
        return f"{type(self).__qualname__}({', '.join(shown)})"
