"""Values of properties and expressions, and what texts in a file count for."""

from __future__ import annotations

from typing import Any

from carom.formats.xacro.limits import MAX_BITS, ExpressionError, check_length

Value = Any
"""None, a bool, an int, a float, a str, a list, a tuple or a dict of these, a namespace, or a function."""

_WORDS = {"true": True, "True": True, "false": False, "False": False}
_LONGEST_NUMBER = 40


def literal(value: Value) -> Value:
    """The number or truth value that a text states; text in single quotes without them; others as they are.

    A text with an underscore is no number, as in the program xacro.
    """
    if not isinstance(value, str):
        return value
    if len(value) >= 2 and value[0] == value[-1] == "'":
        return value[1:-1]
    if "_" in value or len(value) > _LONGEST_NUMBER:
        return value
    for kind in (int, float):
        try:
            return kind(value)
        except ValueError:
            continue
    return _WORDS.get(value, value)


def truth(value: Value) -> bool:
    """What a condition counts for: a truth value, a number, or a text that states one of these.

    Raises:
        ExpressionError: It is another text.
    """
    if not isinstance(value, str):
        return bool(value)
    text = value.strip()
    if text in _WORDS:
        return _WORDS[text]
    try:
        return bool(float(text))
    except ValueError:
        raise ExpressionError(
            f"{value[:60]!r} is neither true nor false; expected true, false or a number"
        ) from None


def text_of(value: Value) -> str:
    """The text of a value, as it is written into a document."""
    if isinstance(value, str):
        return value
    check_length(size_of(value))
    return str(value)


def size_of(value: Value, depth: int = 0) -> int:
    """About how long the text of a value is."""
    if isinstance(value, str):
        return len(value)
    if depth > 20:
        raise ExpressionError("lists nested deeper than 20 are refused")
    if isinstance(value, (list, tuple, dict)):
        total = 0
        entries = [*value.keys(), *value.values()] if isinstance(value, dict) else value
        for entry in entries:
            total += 2 + size_of(entry, depth + 1)
            check_length(total)
        return total
    return 8


def checked(value: Value) -> Value:
    """A result of arithmetic, unless it is too large or no real number."""
    if isinstance(value, int) and value.bit_length() > MAX_BITS:
        raise ExpressionError(f"a whole number of more than {MAX_BITS} bits is refused")
    if isinstance(value, complex):
        raise ExpressionError("the result is no real number")
    if isinstance(value, (str, list, tuple)):
        check_length(len(value))
    return value
