"""Objects that refuse attributes which they do not have, and list those for users only."""

from __future__ import annotations

from abc import ABCMeta
from typing import Any

_NOTHING = object()


def _hidden(kind: type) -> set[str]:
    """Names of a class that only other packages of Carom use."""
    from carom.internal_names import INTERNAL

    return {name for base in kind.__mro__ for name in INTERNAL.get(base.__name__, ())}


class Listed(ABCMeta):
    """Class of classes of which `dir`, and so `help`, list the names for users; others are there as well."""

    def __dir__(cls) -> list[str]:
        hidden = _hidden(cls)
        return [name for name in super().__dir__() if name not in hidden]


class Closed:
    """Base class: after `_close`, only attributes that are there can be set, and methods only to functions.

    Names with an underscore in front stay free, and so do all names in subclasses that users derive from the
    class that has closed itself. There is no `__getattr__`, with which all attributes would take longer, also
    those that are there: what is meant by one that is not is said when the error is printed, by
    `carom.suggestions`.
    """

    def _close(self, own: type | None = None) -> None:
        """Refuse new attributes from now on; if `own` is stated, only of objects of this class itself."""
        if own is None or type(self) is own:
            self.__dict__["_closed"] = True

    def __dir__(self) -> list[str]:
        hidden = _hidden(type(self))
        return [name for name in object.__dir__(self) if name not in hidden]

    def __setattr__(self, name: str, value: Any) -> None:
        if name[0] != "_" and "_closed" in self.__dict__:
            known = getattr(type(self), name, _NOTHING)
            if known is _NOTHING:
                if name not in self.__dict__:
                    from carom.foreign_names import attribute_error

                    raise attribute_error(self, name)
            # A property is not callable; a function may take the place of a method, as tests want it.
            elif callable(known) and not callable(value):
                raise AttributeError(
                    f"{type(self).__name__}.{name} is a method, which is called: {name}(...); it cannot be "
                    f"{value!r}"
                )
        object.__setattr__(self, name, value)
