"""Data classes that are quick to define: `@record` in place of `@dataclass(frozen=True, slots=True)`.

`dataclasses` generates and compiles up to eight methods for every class, which takes about half a
millisecond. A process defines sixty classes before its first step; this was a fifth of the time until then.
The methods here are the same for all classes and are compiled with this module. Making an object takes a few
microseconds instead of one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import MISSING, FrozenInstanceError, dataclass, field, fields
from typing import TYPE_CHECKING, Any, NoReturn, TypeVar, overload

if TYPE_CHECKING:
    from inspect import Signature

    from typing_extensions import dataclass_transform
else:

    def dataclass_transform(**_: Any) -> Callable[[Any], Any]:
        """Stand-in for `typing.dataclass_transform` (Python 3.11), which only type checkers use."""
        return lambda function: function


Class = TypeVar("Class", bound=type)


@overload
def record(cls: Class, /) -> Class: ...
@overload
def record(*, frozen: bool = ..., eq: bool = ..., hot: bool = ...) -> Callable[[Class], Class]: ...
@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def record(cls: type | None = None, /, *, frozen: bool = True, eq: bool = True, hot: bool = False) -> Any:
    """Make a class a data class with slots, as `dataclasses.dataclass` does.

    Args:
        cls: The class, if the decorator is used without parentheses.
        frozen: Whether objects cannot be changed.
        eq: Whether objects with equal fields are equal, and hashable if they are frozen. Otherwise objects
            are compared by identity, which classes with arrays as fields need.
        hot: Whether objects are made or compared often: then the class has an `__init__` and an `__eq__` of
            its own, which take a tenth of a millisecond to define and a fraction of the time to run.
    """

    def made(cls: type) -> type:
        own = {*cls.__dict__, "__init__", "__eq__", "__hash__"} if hot else set(cls.__dict__)
        cls = dataclass(init=hot, repr=False, eq=hot and eq, slots=True, frozen=hot and frozen)(cls)
        methods: dict[str, Any] = {"__init__": _init, "__repr__": _repr, "__reduce__": _reduce}
        if eq:
            methods |= {"__eq__": _eq, "__hash__": _hash if frozen else None}
        if frozen:
            methods |= {"__setattr__": _refuse_to_set, "__delattr__": _refuse_to_delete}
        for name, method in methods.items():
            if name not in own:
                setattr(cls, name, method)
        cls.__signature__ = _SIGNATURE
        cls.__compared__ = tuple([known.name for known in fields(cls) if known.compare])
        cls.__finishes__ = hasattr(cls, "__post_init__")
        return cls

    return made if cls is None else made(cls)


def _init(self: Any, /, *values: Any, **named: Any) -> None:
    """Set the fields from positional and keyword arguments, or to their defaults."""
    known = self.__dataclass_fields__
    put = object.__setattr__
    for value, name in zip(values, known):  # noqa: B905  # `_fill` sets the remaining fields
        put(self, name, value)
    if named or len(values) != len(known):
        _fill(self, len(values), named)
    if self.__finishes__:
        self.__post_init__()


def _fill(self: Any, given: int, named: dict[str, Any]) -> None:
    """Set the fields that were not given by position."""
    known = self.__dataclass_fields__
    put = object.__setattr__
    if given > len(known):
        raise _wrong_arguments(self, f"takes {len(known)} values, not {given}")
    for name in tuple(known)[given:]:
        if name in named:
            put(self, name, named.pop(name))
        elif (default := known[name].default) is not MISSING:
            put(self, name, default)
        elif (factory := known[name].default_factory) is not MISSING:
            put(self, name, factory())
        else:
            raise _wrong_arguments(self, f"needs {name!r}")
    for name in named:
        what = f"was given {name!r} twice" if name in known else f"has no field {name!r}"
        raise _wrong_arguments(self, what)


def _wrong_arguments(self: object, what: str) -> TypeError:
    return TypeError(f"{type(self).__name__} {what}")


def _repr(self: Any) -> str:
    values = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.__dataclass_fields__)
    return f"{type(self).__qualname__}({values})"


def _values(self: Any) -> tuple[Any, ...]:
    """Values of the fields that are compared."""
    return tuple([getattr(self, name) for name in self.__compared__])


def _eq(self: object, other: object) -> bool:
    return _values(self) == _values(other) if other.__class__ is self.__class__ else NotImplemented


def _hash(self: object) -> int:
    return hash(_values(self))


def _reduce(self: Any) -> tuple[type, tuple[Any, ...]]:
    """For pickling and copying, which by default would assign to the slots; frozen objects refuse that."""
    return type(self), tuple(getattr(self, name) for name in self.__dataclass_fields__)


def _refuse_to_set(self: object, name: str, value: object) -> NoReturn:
    raise FrozenInstanceError(f"cannot assign to field {name!r}")


def _refuse_to_delete(self: object, name: str) -> NoReturn:
    raise FrozenInstanceError(f"cannot delete field {name!r}")


class _Signature:
    """The signature of a class that `inspect` and `help` show, computed on demand."""

    def __get__(self, instance: object, owner: Any) -> Signature:
        from inspect import Parameter, Signature

        parameters = []
        for known in fields(owner):
            default = known.default
            if known.default_factory is not MISSING:
                default = known.default_factory
            shown = Parameter.empty if default is MISSING else default
            parameters.append(
                Parameter(known.name, Parameter.POSITIONAL_OR_KEYWORD, default=shown, annotation=known.type)
            )
        return Signature(parameters)


_SIGNATURE = _Signature()
