"""Data classes whose methods are compiled when they pay.

The standard library's decorator compiles each method of each class as its module is imported. That takes a
millisecond a class, a fifth of the time that a script needs to its first step, and most of it for methods
that are never called. Here a class with `slots=True` has placeholders at first, and its first objects set
their fields one by one. After `FIRST_OBJECTS`, or once something else is asked for, as the fields by
`dataclasses.fields`, the standard library makes its methods; comparison needs none of them. Classes without
slots, or with unusual fields or options, are made by the standard library at once. Until then its module,
which takes longer to import than ten of ours, is not imported: `field`, `fields` and `replace` are here, too.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from functools import partial
from operator import attrgetter
from typing import TYPE_CHECKING, Any

from carom.forks import free_in_forks

__all__ = ["FIRST_OBJECTS", "dataclass", "field", "field_names", "fields", "replace"]

FIRST_OBJECTS = 200
"""So many objects take as long without compiled methods as compiling them."""

_FIELDS = "__dataclass_fields__"
_MISSING = object()
_USUAL_OPTIONS = {"frozen", "eq", "repr", "slots"}
_USUAL_FIELD_OPTIONS = {"default", "default_factory", "repr", "compare", "metadata"}
# In annotations: what is no field, or one of another kind.
_UNUSUAL_FIELDS = ("ClassVar", "InitVar", "KW_ONLY")
# The standard library treats these in ways of its own if a class has them.
_UNUSUAL_MEMBERS = {"__eq__", "__hash__", "__setattr__", "__delattr__", "__getstate__", "__slots__"}
_put = object.__setattr__
_making = free_in_forks(threading.RLock())
_lazy: dict[type, _LazyClass] = {}

if TYPE_CHECKING:
    from dataclasses import dataclass, field, fields, replace
else:

    def dataclass(cls: type | None = None, /, **options: bool) -> Any:
        """As `dataclasses.dataclass`; only when methods are compiled differs."""

        def made(plain: type) -> type:
            return _made(plain, options)

        return made if cls is None else made(cls)

    def field(**options: Any) -> Any:
        """As `dataclasses.field`."""
        return _Field(options)

    def fields(class_or_instance: Any) -> Any:
        """As `dataclasses.fields`."""
        from dataclasses import fields

        return fields(class_or_instance)

    def replace(instance: Any, /, **changes: Any) -> Any:
        """As `dataclasses.replace`."""
        from dataclasses import replace

        return replace(instance, **changes)


def field_names(cls: type) -> tuple[str, ...]:
    """The names of the fields of a data class; its methods are not compiled for it."""
    if cls in _lazy:
        return tuple(_lazy[cls].defaults)
    return tuple(field.name for field in fields(cls))


class _Field:
    """What a class says of a field."""

    __slots__ = ("options",)

    def __init__(self, options: dict[str, Any]) -> None:
        self.options = options


def _made(plain: type, options: dict[str, bool]) -> type:
    bases = [base for base in plain.__mro__[:0:-1] if _FIELDS in base.__dict__]
    if (
        not options.get("slots")
        or options.keys() - _USUAL_OPTIONS
        or _UNUSUAL_MEMBERS & plain.__dict__.keys()
        or not all(base in _lazy for base in bases)
        or (own := _own_defaults(plain)) is None
    ):
        return _made_by_standard(plain, options)
    return _LazyClass(plain, options, own, [_lazy[base] for base in bases]).made


def _made_by_standard(plain: type, options: dict[str, bool]) -> type:
    import dataclasses

    for name, value in list(plain.__dict__.items()):
        if type(value) is _Field:
            setattr(plain, name, dataclasses.field(**value.options))
    return dataclasses.dataclass(**options)(plain)


def _own_defaults(plain: type) -> dict[str, Any] | None:
    """Default of each field that a class adds, or the `_Field` with its factory; None if one is unusual."""
    kinds = plain.__annotations__
    text = " ".join(map(str, kinds.values()))
    if any(word in text for word in _UNUSUAL_FIELDS):
        return None
    content = plain.__dict__
    defaults: dict[str, Any] = {}
    for name in kinds:
        default = content.get(name, _MISSING)
        if type(default) is _Field:
            if default.options.keys() - _USUAL_FIELD_OPTIONS:
                return None
            if "default_factory" not in default.options:
                default = default.options.get("default", _MISSING)
        elif type(default).__module__ == "dataclasses":
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
        self.compared += [name for name in own if _is_compared(plain.__dict__.get(name))]
        self._plain = plain
        self._options = {name: value for name, value in options.items() if name != "slots"}
        self._is_frozen = options.get("frozen", False)
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
        content["__init__"] = _Initialiser(self)
        if self._is_frozen:
            content |= _members_of_frozen(self)
        self.made: type = type(plain)(plain.__name__, plain.__bases__, content)
        self.made.__qualname__ = plain.__qualname__
        self._factories: list[tuple[str, Any]] = []
        self._values: dict[str, Any] = {}
        for name, default in self.defaults.items():
            if type(default) is _Field:
                self._factories.append((name, default.options["default_factory"]))
                self._values[name] = _MISSING
            elif default is not _MISSING:
                self._values[name] = default
        self._goes_on = hasattr(self.made, "__post_init__")
        _lazy[self.made] = self

    def _made_later(self) -> list[str]:
        names = [_FIELDS, "__dataclass_params__"]
        if sys.version_info >= (3, 13):
            names.append("__replace__")
        if self._options.get("repr", True) and "__repr__" not in self._plain.__dict__:
            names.append("__repr__")
        return names

    def make(self) -> None:
        """Replace all placeholders by what the standard library makes."""
        with _making:
            # Unless another thread was faster.
            if isinstance(self.made.__dict__["__init__"], _Placeholder):
                _made_by_standard(self._plain, self._options)
                for name, value in self._plain.__dict__.items():
                    if isinstance(self.made.__dict__.get(name), _Placeholder):
                        setattr(self.made, name, value)

    def initialise(self, instance: Any, /, *arguments: Any, **named: Any) -> None:
        """What `__init__` does, without compiled code."""
        values = self._values | named
        if arguments:
            placed = dict(zip(self.defaults, arguments, strict=False))
            values |= placed
        else:
            placed = {}
        if (
            values.keys() != self.defaults.keys()
            or len(placed) < len(arguments)
            or named.keys() & placed.keys()
        ):
            # The compiled method says what is wrong.
            self.make()
            vars(self.made)["__init__"](instance, *arguments, **named)
            return
        for name, make in self._factories:
            if values[name] is _MISSING:
                values[name] = make()
        for name, value in values.items():
            _put(instance, name, value)
        if self._goes_on:
            instance.__post_init__()


class _Placeholder:
    """Stands for an attribute of a class; once asked for it, it has it made.

    Python asks it for methods as `__repr__`, too, when it looks them up for a function.
    """

    __slots__ = ("_name", "lazy_class")

    def __init__(self, name: str, lazy_class: _LazyClass) -> None:
        self._name = name
        self.lazy_class = lazy_class

    def __get__(self, instance: Any, owner: type) -> Any:
        self.lazy_class.make()
        # Not that of the object, whose class may be derived and have its own.
        made = vars(self.lazy_class.made)[self._name]
        return made.__get__(instance, owner) if hasattr(made, "__get__") else made


class _Initialiser(_Placeholder):
    """The placeholder of `__init__`, which does its work for the first objects."""

    __slots__ = ("_left",)

    def __init__(self, lazy_class: _LazyClass) -> None:
        super().__init__("__init__", lazy_class)
        self._left = FIRST_OBJECTS

    def __get__(self, instance: Any, owner: type) -> Any:
        if instance is None or self._left <= 0:
            return super().__get__(instance, owner)
        self._left -= 1
        return partial(self.lazy_class.initialise, instance)


def _is_compared(declared: Any) -> bool:
    return type(declared) is not _Field or declared.options.get("compare", True)


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
            from dataclasses import FrozenInstanceError

            raise FrozenInstanceError(f"cannot {verb} field {name!r}")

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
            _put(self, name, value)

    return {method.__name__: method for method in (__setattr__, __delattr__, __getstate__, __setstate__)}
