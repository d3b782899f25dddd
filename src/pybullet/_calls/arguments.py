"""Checks and conversions of arguments: a wrong argument raises a clear error and never corrupts the world.

Calls that loops make every step read usual arguments in the native library; what that leaves to Python comes
here: these functions raise the error, or convert arguments of unusual types.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Sequence
from contextlib import suppress
from itertools import islice
from math import hypot, inf, isfinite, nan
from operator import index
from typing import Any, NoReturn, SupportsFloat

from carom.layouts.magnitudes import MAX_MAGNITUDE, MAX_SQUARE, MIN_SQUARE
from pybullet._calls.errors import fail

_ONLY_INTEGERS = frozenset((int,))
# Types whose lengths are certainly those of what is read.
# Not ranges: Python may be unable to say how long one is.
_PLAIN = frozenset((list, tuple))
_MIN_INT, _MAX_INT = -(2**31), 2**31 - 1
MAX_ITEMS = 1 << 24
"""Greatest length of sequences whose length no other argument determines."""

# For a type checker, lists, tuples, ranges and NumPy arrays are all iterables, but not all sequences. At run
# time only those are accepted that have a length, which is checked before anything is read.
Vector = Iterable[float]
Indices = Iterable[int]
Vectors = Iterable[Vector]

NOT_GIVEN: Any = None
"""The default of arguments that a function requires, and misses itself: see `exported_requiring`."""


def integer(value: Any, name: str) -> int:
    """A signed 32-bit integer; raises `TypeError` or, if it needs more bits, `OverflowError` for others."""
    if type(value) is int and _MIN_INT <= value <= _MAX_INT:
        return value
    try:
        number = index(value)
    except TypeError as problem:
        raise TypeError(f"{problem} ({name})") from None
    if number > _MAX_INT:
        raise OverflowError(f"signed integer is greater than maximum ({name})")
    if number < _MIN_INT:
        raise OverflowError(f"signed integer is less than minimum ({name})")
    return number


def real(value: Any, name: str, problem: str = "") -> float:
    """A finite number; others raise `TypeError`, or `pybullet.error` with `problem` (infinity, NaN)."""
    kind = type(value)
    if kind is float and isfinite(value):
        return value
    if kind is int and -_MAX_INT <= value <= _MAX_INT:
        return float(value)
    number = _as_float(value, name)
    if not isfinite(number):
        particulars = f"{name} has to be a finite number, not {number}."
        fail(problem or particulars, particulars if problem else "")
    return number


def bound(value: Any, name: str) -> float:
    """A number or infinity, which stands for no limit; NaN and minus infinity raise `pybullet.error`."""
    if type(value) is float and value > -inf:
        return value
    number = _as_float(value, name)
    if number == inf:
        return number
    return real(number, name)


def text(value: Any, name: str) -> str:
    """A string; raises `TypeError` for others."""
    if not isinstance(value, str):
        raise TypeError(f"argument must be str, not {type(value).__name__} ({name})")
    return value


def _as_float(value: Any, name: str) -> float:
    if isinstance(value, (str, bytes, bytearray)):
        raise TypeError(f"must be real number, not {type(value).__name__} ({name})")
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"must be real number, not {type(value).__name__} ({name})") from None


def by_name(
    function: str, names: Sequence[str], arguments: tuple[Any, ...], keywords: dict[str, Any]
) -> dict[str, Any]:
    """The arguments of a call after the first one, by name, for functions with different lists of arguments.

    Raises:
        TypeError: There are too many arguments, one is unknown, or one is given twice.
    """
    if len(arguments) > len(names):
        raise TypeError(f"{function}() takes at most {len(names) + 1} arguments ({len(arguments) + 1} given)")
    given = dict(zip(names, arguments, strict=False))
    for name, value in keywords.items():
        if name not in names:
            raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
        if name in given:
            raise TypeError(f"{function}() got multiple values for argument {name!r}")
        given[name] = value
    return given


def one_body(body_unique_id: Any, body_index: Any, function: str) -> Any:
    """The body of a call, given as `bodyUniqueId` or `bodyIndex`; `TypeError` if neither or both are."""
    if body_unique_id is None and body_index is None:
        raise TypeError(f"{function}() missing required argument 'bodyUniqueId' (pos 1)")
    if body_unique_id is not None and body_index is not None:
        raise TypeError(f"{function}() got both 'bodyUniqueId' and 'bodyIndex'")
    return body_index if body_unique_id is None else body_unique_id


def required(function: str, **arguments: Any) -> None:
    """Raises `TypeError` for the first of the arguments that is None."""
    for name, value in arguments.items():
        if value is None:
            raise TypeError(f"{function}() missing required argument {name!r}")


def numbers(values: Any, problem: str, name: str) -> tuple[float, ...]:
    """Finite numbers from any sequence, also an array of one axis; raises `pybullet.error` for others."""
    if isinstance(values, (list, tuple)):
        try:
            if -inf < sum(values) < inf:
                return tuple(map(float, values))
        except (TypeError, ValueError):
            pass
    result = array("d")
    count = _checked_length(values, problem, name, MAX_ITEMS)
    try:
        result.extend(islice(values, count))
    except TypeError:
        for position, item in enumerate(sequence(values, problem, name)):
            if not isinstance(item, SupportsFloat):
                fail(problem, f"{name}[{position}] is {item!r}, not a number.")
        fail(problem, f"{name} is {values!r}.")
    if not -inf < sum(result) < inf:
        for position, item in enumerate(result):
            if not isfinite(item):
                fail(problem, f"{name}[{position}] is {item}.")
    return tuple(result)


def vector3(values: Any, problem: str, name: str) -> tuple[float, float, float]:
    """Three quantities; raises `pybullet.error` as `quantities` does, and if there are more or fewer."""
    try:
        if len(values) == 3:
            x, y, z = values
            if abs(x) + abs(y) + abs(z) <= MAX_MAGNITUDE:
                return float(x), float(y), float(z)
    except (TypeError, ValueError, OverflowError):
        pass
    x, y, z = _counted(values, 3, problem, name)
    return x, y, z


def vector4(values: Any, problem: str, name: str) -> tuple[float, float, float, float]:
    """Four quantities; raises `pybullet.error` as `quantities` does, and if there are more or fewer."""
    try:
        if len(values) == 4:
            x, y, z, w = values
            if abs(x) + abs(y) + abs(z) + abs(w) <= MAX_MAGNITUDE:
                return float(x), float(y), float(z), float(w)
    except (TypeError, ValueError, OverflowError):
        pass
    x, y, z, w = _counted(values, 4, problem, name)
    return x, y, z, w


def rotation(values: Any, problem: str, name: str) -> tuple[float, float, float, float]:
    """A quaternion (x, y, z, w) that can be normalised; raises `pybullet.error` for others."""
    x, y, z, w = vector4(values, problem, name)
    squared = x * x + y * y + z * z + w * w
    if not MIN_SQUARE < squared < MAX_SQUARE:
        _refuse_rotation((x, y, z, w), problem, name)
    return x, y, z, w


def check_rotation(values: Sequence[float], problem: str, name: str) -> None:
    """Raises `pybullet.error` for a quaternion (x, y, z, w) that cannot be normalised."""
    x, y, z, w = values
    if not MIN_SQUARE < x * x + y * y + z * z + w * w < MAX_SQUARE:
        _refuse_rotation(values, problem, name)


def _refuse_rotation(values: Sequence[float], problem: str, name: str) -> NoReturn:
    length = hypot(*values)
    about = "is no rotation" if length < 1.0 else "is too long for a rotation"
    fail(problem, f"{name} is a quaternion of length {length:g}, which {about}.")


def moderate(value: float, problem: str, name: str) -> float:
    """A number whose magnitude is at most `MAX_MAGNITUDE`; raises `pybullet.error` for others.

    Products of a few such numbers do not overflow.
    """
    if not abs(value) <= MAX_MAGNITUDE:
        particulars = f"{name} is {value:g}; it has to be from {-MAX_MAGNITUDE:g} to {MAX_MAGNITUDE:g}."
        fail(problem or particulars, particulars if problem else "")
    return value


def quantity(value: Any, name: str) -> float:
    """A number as from `real` that kernels can compute with: its magnitude is at most `MAX_MAGNITUDE`."""
    return moderate(real(value, name), "", name)


def quantities(values: Any, problem: str, name: str) -> tuple[float, ...]:
    """As `numbers`, with the bound of `quantity` for each item."""
    result = numbers(values, problem, name)
    for item in result:
        if abs(item) > MAX_MAGNITUDE:
            moderate(item, problem, f"An item of {name}")
    return result


def _counted(values: Any, count: int, problem: str, name: str) -> tuple[float, ...]:
    given = length(values, problem, name)
    if given != count:
        fail(problem, f"{name} has {given} values instead of {count}.")
    result = quantities(values, problem, name)
    if len(result) != count:
        fail(problem, f"{name} holds {len(result)} values instead of {count}.")
    return result


def length(values: Any, problem: str, name: str) -> int:
    """The length of any sequence, of which no item is read; raises `pybullet.error` for other values.

    As in PyBullet, generators and other iterators are no sequences: they may have no end.
    """
    try:
        return len(values)
    except OverflowError:
        fail(problem, f"{name} has more than {MAX_ITEMS} items, which are too many.")
    except (TypeError, ValueError):
        hint = "; it has no length: pass a list" if hasattr(values, "__next__") else ""
        fail(problem, f"{name} is {values!r}{hint}.")


def _checked_length(values: Any, problem: str, name: str, most: int) -> int:
    count = length(values, problem, name)
    if count > most:
        fail(problem, f"{name} has {count} items; at most {most} are accepted.")
    return count


def sequence(values: Any, problem: str, name: str, most: int = MAX_ITEMS) -> tuple[Any, ...]:
    """The items of any sequence of at most `most`; raises `pybullet.error` if `values` is none."""
    if type(values) in _PLAIN and len(values) <= most:
        return tuple(values)
    count = _checked_length(values, problem, name, most)
    try:
        return tuple(islice(values, count))
    except TypeError:
        fail(problem, f"{name} is {values!r}.")


def indices(values: Any, problem: str, name: str) -> tuple[int, ...]:
    """Indices from any sequence of integers or of whole floats; raises `pybullet.error` for others."""
    items = sequence(values, problem, name)
    if _ONLY_INTEGERS.issuperset(map(type, items)):
        return items
    return tuple([_as_index(item, name) for item in items])


def _as_index(item: Any, name: str) -> int:
    try:
        return index(item)
    except TypeError:
        number = nan
        with suppress(TypeError, ValueError):
            number = float(item) if isinstance(item, SupportsFloat) else nan
        if number.is_integer():
            return int(number)
    fail("Joint index out-of-range.", f"{name} contains {item!r}, which is no index.")
