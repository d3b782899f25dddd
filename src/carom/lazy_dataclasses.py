"""Data classes whose methods are compiled when they are first needed.

The standard library's decorator compiles each method of each class as its module is imported. That takes a
millisecond a class, a fifth of the time that a script needs to its first step, and most of it for methods
that are never called. Here a class with `slots=True` has placeholders at first. Its first object compiles
`__init__`; whatever else is asked for, as the fields by `dataclasses.fields`, has the standard library make
the rest; comparison needs no code of its own. Classes without slots, or with unusual fields or options, are
made by the standard library at once.
"""

from __future__ import annotations

import dataclasses
import sys
import threading
from collections.abc import Callable
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from carom.forks import free_in_forks

__all__ = ["dataclass", "field_names"]

_FIELDS = "__dataclass_fields__"
_MISSING = dataclasses.MISSING
_USUAL_OPTIONS = {"frozen", "eq", "repr", "slots"}
# In annotations: what is no field, or one of another kind.
_UNUSUAL_FIELDS = ("ClassVar", "InitVar", "KW_ONLY")
# The standard library treats these in ways of its own if a class has them.
_UNUSUAL_MEMBERS = {"__eq__", "__hash__", "__setattr__", "__delattr__", "__getstate__", "__slots__"}
_making = free_in_forks(threading.RLock())
_lazy: dict[type, _LazyClass] = {}

if TYPE_CHECKING:
    from dataclasses import dataclass
else:

    def dataclass(cls: type | None = None, /, **options: bool) -> Any:
        """As `dataclasses.dataclass`; only when methods are compiled differs."""

        def made(plain: type) -> type:
            return _made(plain, options)

        return made if cls is None else made(cls)


def field_names(cls: type) -> tuple[str, ...]:
    """The names of the fields of a data class; its methods are not compiled for it."""
    if cls in _lazy:
        return tuple(_lazy[cls].defaults)
    return tuple(field.name for field in dataclasses.fields(cls))


def _made(plain: type, options: dict[str, bool]) -> type:
    own = _own_defaults(plain)
    bases = [base for base in plain.__mro__[:0:-1] if _FIELDS in base.__dict__]
    if (
        own is None
        or not options.get("slots")
        or options.keys() - _USUAL_OPTIONS
        or _UNUSUAL_MEMBERS & plain.__dict__.keys()
        or not all(base in _lazy for base in bases)
    ):
        return dataclasses.dataclass(**options)(plain)
    return _LazyClass(plain, options, own, [_lazy[base] for base in bases]).made


def _own_defaults(plain: type) -> dict[str, Any] | None:
    """Default of each field that a class adds, or the `Field` with its factory; None if one is unusual."""
    defaults: dict[str, Any] = {}
    for name, kind in plain.__annotations__.items():
        default = plain.__dict__.get(name, _MISSING)
        if isinstance(default, dataclasses.Field):
            if not default.init or default.kw_only is True or default.hash is not None:
                return None
            if default.default_factory is _MISSING:
                default = default.default
        if any(word in str(kind) for word in _UNUSUAL_FIELDS):
            return None
        defaults[name] = default
    return defaults


class _LazyClass:
    """A class with placeholders, and how to replace them.

    Attributes:
        made: The class.
        defaults: Default of each of its fields, as `_own_defaults` returns them.
        compared: Those of its fields that are compared.
    """

    def __init__(
        self, plain: type, options: dict[str, bool], own: dict[str, Any], bases: list[_LazyClass]
    ) -> None:
        self.defaults = {name: value for base in bases for name, value in base.defaults.items()} | own
        self.compared = [name for base in bases for name in base.compared if name not in own]
        self.compared += [name for name in own if getattr(plain.__dict__.get(name), "compare", True)]
        self._plain = plain
        self._options = {name: value for name, value in options.items() if name != "slots"}
        self._is_frozen = options.get("frozen", False)
        self._is_whole = False
        content = {name: value for name, value in plain.__dict__.items() if name not in own}
        for name in ("__dict__", "__weakref__"):
            content.pop(name, None)
        taken = {slot for base in plain.__mro__[1:-1] for slot in base.__dict__.get("__slots__", ())}
        content["__slots__"] = tuple(name for name in own if name not in taken)
        content.setdefault("__match_args__", tuple(self.defaults))
        if options.get("eq", True):
            content |= _comparison(self)
            if not self._is_frozen:
                content["__hash__"] = None
        content |= {name: _Placeholder(name, self) for name in self._made_later()}
        if self._is_frozen:
            content |= _members_of_frozen(self)
        self.made: type = type(plain)(plain.__name__, plain.__bases__, content)
        self.made.__qualname__ = plain.__qualname__
        _lazy[self.made] = self

    def _made_later(self) -> list[str]:
        names = ["__init__", _FIELDS, "__dataclass_params__"]
        if sys.version_info >= (3, 13):
            names.append("__replace__")
        if self._options.get("repr", True) and "__repr__" not in self._plain.__dict__:
            names.append("__repr__")
        return names

    def make(self, name: str) -> None:
        """Replace the placeholder of this name, and others if the standard library makes it."""
        with _making:
            if not isinstance(self.made.__dict__[name], _Placeholder):
                # Another thread was faster.
                return
            if name == "__init__":
                self.made.__init__ = self._initialiser()
                return
            dataclasses.dataclass(**self._options)(self._plain)
            for key, value in self._plain.__dict__.items():
                if isinstance(self.made.__dict__.get(key), _Placeholder):
                    setattr(self.made, key, value)

    def _initialiser(self) -> Any:
        parameters, lines = ["self"], []
        known: dict[str, Any] = {"_missing": _MISSING}
        for name, default in self.defaults.items():
            value = name
            if default is _MISSING:
                parameters.append(name)
            elif isinstance(default, dataclasses.Field):
                known[f"_make_{name}"] = default.default_factory
                parameters.append(f"{name}=_missing")
                value = f"_make_{name}() if {name} is _missing else {name}"
            else:
                known[f"_default_{name}"] = default
                parameters.append(f"{name}=_default_{name}")
            if self._is_frozen:
                known[f"_set_{name}"] = getattr(self.made, name).__set__
                lines.append(f"_set_{name}(self, {value})")
            else:
                lines.append(f"self.{name} = {value}")
        if hasattr(self.made, "__post_init__"):
            lines.append("self.__post_init__()")
        text = "\n".join(
            (
                f"def _with({', '.join(known)}):",
                f" def __init__({', '.join(parameters)}):",
                *(f"  {line}" for line in lines or ["pass"]),
                " return __init__",
            )
        )
        place: dict[str, Any] = {}
        exec(text, vars(sys.modules[self.made.__module__]), place)
        initialiser = place["_with"](**known)
        initialiser.__qualname__ = f"{self.made.__qualname__}.__init__"
        initialiser.__annotations__ = {**self._kinds(), "return": None}
        return initialiser

    def _kinds(self) -> dict[str, Any]:
        return {
            name: kind
            for base in reversed(self.made.__mro__)
            for name, kind in (_lazy[base]._plain.__annotations__ if base in _lazy else {}).items()
        }


class _Placeholder:
    """Stands for an attribute of a class; once asked for it, it has it made.

    Python asks it for methods as `__init__`, too, when it looks them up for a class.
    """

    __slots__ = ("_lazy_class", "_name")

    def __init__(self, name: str, lazy_class: _LazyClass) -> None:
        self._name = name
        self._lazy_class = lazy_class

    def __get__(self, instance: Any, owner: type) -> Any:
        self._lazy_class.make(self._name)
        return getattr(owner if instance is None else instance, self._name)


def _comparison(lazy_class: _LazyClass) -> dict[str, Any]:
    names = lazy_class.compared
    values: Callable[[Any], Any] = attrgetter(*names) if len(names) > 1 else _few(names)

    def __eq__(self: Any, other: object) -> bool:
        if other.__class__ is not self.__class__:
            return NotImplemented
        return values(self) == values(other)

    def __hash__(self: Any) -> int:
        return hash(values(self))

    return {"__eq__": __eq__, "__hash__": __hash__}


def _few(names: list[str]) -> Callable[[Any], Any]:
    """As `attrgetter`, whose result for a single name is no tuple, and which cannot have none."""
    return lambda instance: tuple(getattr(instance, name) for name in names)


def _members_of_frozen(lazy_class: _LazyClass) -> dict[str, Any]:
    """The methods that refuse changes, and those for pickles, which may not use them."""
    defaults = lazy_class.defaults

    def refuse(instance: Any, name: str, verb: str) -> None:
        if type(instance) is lazy_class.made or name in defaults:
            raise dataclasses.FrozenInstanceError(f"cannot {verb} field {name!r}")

    def __setattr__(self: Any, name: str, value: Any) -> None:
        refuse(self, name, "assign to")
        super(lazy_class.made, self).__setattr__(name, value)

    def __delattr__(self: Any, name: str) -> None:
        refuse(self, name, "delete")
        super(lazy_class.made, self).__delattr__(name)

    def __getstate__(self: Any) -> list[Any]:
        return [getattr(self, name) for name in defaults]

    def __setstate__(self: Any, state: list[Any]) -> None:
        for name, value in zip(defaults, state, strict=False):
            object.__setattr__(self, name, value)

    return {method.__name__: method for method in (__setattr__, __delattr__, __getstate__, __setstate__)}
