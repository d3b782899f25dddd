"""Named tuples whose annotations are not compiled.

`typing.NamedTuple` compiles the annotation of each field as its module is imported, to see whether it is a
type. Type checkers see to that, and it takes most of the time in which such a class is made: two dozen are
made before a first step.
"""

from __future__ import annotations

from collections import namedtuple
from typing import TYPE_CHECKING, Any

__all__ = ["NamedTuple"]

if TYPE_CHECKING:
    from typing import NamedTuple
else:

    class _Made(type):
        """Makes a tuple class of what is derived from `NamedTuple`."""

        def __new__(cls, name: str, bases: tuple[type, ...], content: dict[str, Any]) -> type:
            if not bases:
                return super().__new__(cls, name, bases, content)
            kinds: dict[str, Any] = content.get("__annotations__", {})
            made = namedtuple(
                name,
                kinds,
                defaults=[content[field] for field in kinds if field in content],
                module=content["__module__"],
            )
            for key, value in content.items():
                if key not in kinds and key not in ("__module__", "__slots__"):
                    setattr(made, key, value)
            return made

    class NamedTuple(metaclass=_Made):
        """As `typing.NamedTuple`, for modules with `from __future__ import annotations`."""
