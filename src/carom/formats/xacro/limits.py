"""Bounds on what a document of macros may take, so that none can hang or fill memory."""

from __future__ import annotations

MAX_STEPS = 2_000_000
"""Most operations of all expressions of a document together; long texts and lists count for more."""

MAX_ELEMENTS = 200_000
"""Most elements that macros, conditions and the result of a document may have together."""

MAX_TEXT = 16 << 20
"""Most characters of text and attributes that an expansion may make."""

MAX_LENGTH = 1_000_000
"""Longest text or list."""

MAX_BITS = 1024
"""Largest whole number, in bits: about that of floating-point numbers."""

MAX_EXPRESSION = 10_000
"""Longest expression, in characters."""

MAX_NESTING = 60
"""Deepest nesting of operations in an expression."""

MAX_DEPTH = 200
"""Deepest nesting of elements, conditions, macros and includes together."""

MAX_PROPERTIES = 40
"""Most properties that refer to each other in a chain."""

_PER_STEP = 64


class ExpressionError(ValueError):
    """A text with expressions cannot be evaluated; the message says why."""


class Budget:
    """What of the bounds a document has used."""

    def __init__(self) -> None:
        self._steps = self._elements = self._text = 0
        self.properties = 0

    def step(self, size: int = 0) -> None:
        """Count one operation, whose result has this length."""
        self._steps += 1 + size // _PER_STEP
        if self._steps > MAX_STEPS:
            raise ExpressionError(f"the expressions of this document take more than {MAX_STEPS} operations")

    def element(self) -> None:
        """Count one element that is processed."""
        self._elements += 1
        if self._elements > MAX_ELEMENTS:
            raise ExpressionError(f"it expands to more than {MAX_ELEMENTS} elements")

    def text(self, length: int) -> None:
        """Count text that was made."""
        self._text += length
        if self._text > MAX_TEXT:
            raise ExpressionError(f"it expands to more than {MAX_TEXT} characters")


def check_length(length: int) -> None:
    """Refuse a text or list that would be too long, before it is made."""
    if length > MAX_LENGTH:
        raise ExpressionError(f"a text or list longer than {MAX_LENGTH} is refused")
