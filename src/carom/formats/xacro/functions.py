"""Functions and methods that expressions may call; none reaches the system, and all end soon."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

from carom.formats.xacro.limits import ExpressionError, check_length
from carom.formats.xacro.values import Value, checked, text_of

_MAX_ARGUMENTS = 1000
_WIDEST = 1000
_MATHS = (
    "acos acosh asin asinh atan atan2 atanh ceil copysign cos cosh degrees erf erfc exp expm1 fabs floor "
    "fmod gamma hypot isclose isfinite isinf isnan lgamma log log10 log1p log2 modf pow radians remainder "
    "sin sinh sqrt tan tanh trunc"
)
_METHODS = (
    "capitalize casefold count endswith find index isalnum isalpha isascii isdecimal isdigit isidentifier "
    "islower isnumeric isspace istitle isupper lower lstrip removeprefix removesuffix rfind rindex "
    "rpartition partition rsplit rstrip split splitlines startswith strip swapcase title upper"
)
_PADDINGS = ("center", "ljust", "rjust", "zfill")


class Namespace(dict[str, Value]):
    """Values by name that expressions reach by a dot, as in `math.pi`."""


def _range(*limits: int) -> list[int]:
    if not all(isinstance(limit, int) for limit in limits):
        raise ExpressionError("range needs whole numbers")
    numbers = range(*limits)
    check_length(len(numbers))
    return list(numbers)


def _whole(value: Value = 0, base: int | None = None) -> int:
    if isinstance(value, str):
        check_length(len(value) * 1000)
        return checked(int(value) if base is None else int(value, base))
    return checked(int(value))


def _text(value: Value = "") -> str:
    return text_of(value)


def _sum(values: Iterable[Value], start: Value = 0) -> Value:
    total = start
    for value in values:
        if isinstance(value, (str, list, tuple)):
            raise ExpressionError("sum needs numbers")
        total = checked(total + value)
    return total


def _round(value: float, digits: int | None = None) -> Value:
    if digits is not None and not -400 <= digits <= 400:
        raise ExpressionError("round to at most 400 digits")
    return round(value, digits) if digits is not None else checked(round(value))


def _tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    """The parts of a text between characters of `sep`."""
    parts, part = [], ""
    for letter in text:
        if letter in sep:
            parts.append(part)
            part = ""
        else:
            part += letter
    return [it for it in (*parts, part) if it or not skip_empty]


def _isinstance(value: Value, kind: Any) -> bool:
    kinds = kind if isinstance(kind, tuple) else (kind,)
    named = {FUNCTIONS[name]: type_ for name, type_ in _TYPES.items()}
    try:
        return isinstance(value, tuple(named[it] for it in kinds))
    except (KeyError, TypeError):
        raise ExpressionError(f"isinstance knows {', '.join(_TYPES)}") from None


def _dict(pairs: Value = (), **named: Value) -> dict[Value, Value]:
    return dict(pairs, **named)


def _list(values: Value = ()) -> list[Value]:
    return list(values)


def _tuple(values: Value = ()) -> tuple[Value, ...]:
    return tuple(values)


def _zip(*several: Iterable[Value]) -> list[tuple[Value, ...]]:
    return list(zip(*several))  # noqa: B905 - as in files


def _float(value: Value = 0.0) -> float:
    return float(value)


def _bool(value: Value = False) -> bool:
    return bool(value)


_TYPES: dict[str, type] = {
    "int": int, "float": float, "str": str, "bool": bool, "list": list, "tuple": tuple, "dict": dict,
}  # fmt: skip
MATHS: Namespace = Namespace(
    {name: getattr(math, name) for name in _MATHS.split()},
    pi=math.pi,
    e=math.e,
    tau=math.tau,
    inf=math.inf,
    nan=math.nan,
)
"""The functions and constants of mathematics by name."""

FUNCTIONS: dict[str, Value] = {
    "abs": abs,
    "all": all,
    "any": any,
    "bool": _bool,
    "dict": _dict,
    "divmod": divmod,
    "enumerate": lambda values, start=0: list(enumerate(values, start)),
    "float": _float,
    "int": _whole,
    "isinstance": _isinstance,
    "len": len,
    "list": _list,
    "max": max,
    "min": min,
    "ord": ord,
    "range": _range,
    "reversed": lambda values: list(reversed(values)),
    "round": _round,
    "sorted": sorted,
    "str": _text,
    "sum": _sum,
    "tuple": _tuple,
    "zip": _zip,
}
"""The builtin functions of expressions by name."""

NAMES: dict[str, Value] = {
    **MATHS,
    **FUNCTIONS,
    "math": MATHS,
    "python": Namespace(FUNCTIONS),
    "true": True,
    "false": False,
}
"""Everything that expressions may name besides properties."""

XACRO_FUNCTIONS: dict[str, Value] = {"tokenize": _tokenize, "dotify": lambda value: value}
"""Functions behind `xacro.` that need nothing of a document; any dict is reached by dots here."""


def method(owner: Value, name: str) -> Callable[..., Value]:
    """A method of a text, list or dict.

    Raises:
        ExpressionError: It is not among those that expressions may call.
    """
    if isinstance(owner, str):
        if name in _METHODS.split():
            return getattr(owner, name)
        if name in _PADDINGS:
            return lambda width, *fill: _padded(owner, name, width, *fill)
        if name == "join":
            return lambda parts: _joined(owner, parts)
        if name == "replace":
            return lambda old, new, most=-1: _replaced(owner, old, new, most)
    elif isinstance(owner, dict):
        if name in ("keys", "values", "items"):
            return lambda: list(getattr(owner, name)())
        if name == "get":
            return owner.get
    elif isinstance(owner, (list, tuple)) and name in ("index", "count"):
        return getattr(owner, name)
    kind = type(owner).__name__
    raise ExpressionError(f"a {kind} has no attribute {name!r} that expressions may use")


def check_call(function: Value, arguments: list[Value]) -> None:
    """Refuse calls that might take long or that call no function of these tables."""
    if not callable(function) or isinstance(function, type):
        raise ExpressionError(f"{text_of(function)[:60]!r} is no function")
    if len(arguments) > _MAX_ARGUMENTS:
        raise ExpressionError(f"more than {_MAX_ARGUMENTS} arguments")


def _padded(text: str, name: str, width: int, *fill: str) -> str:
    if not isinstance(width, int) or width > _WIDEST:
        raise ExpressionError(f"{name} pads to at most {_WIDEST} characters")
    return getattr(text, name)(width, *fill)


def _joined(separator: str, parts: Iterable[Value]) -> str:
    texts = [part for part in parts if isinstance(part, str)]
    check_length(sum(map(len, texts)) + len(separator) * len(texts))
    return separator.join(parts)


def _replaced(text: str, old: str, new: str, most: int) -> str:
    check_length(len(text) + text.count(old) * len(new))
    return text.replace(old, new, most)
