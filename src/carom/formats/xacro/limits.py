"""Bounds on what a document of macros may be like, and what it uses of the budget of its reading.

So none can hang or fill memory, see `carom.files.budget`.
"""

from __future__ import annotations

from carom.files.budget import GRAIN, charge, check_time, excess, left

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


class Allowance:
    """What a document has used of what is left of the budget, which it takes at the end by `settle`."""

    def __init__(self) -> None:
        self._steps = self._elements = self._text = 0
        self._most_steps, self._most_elements = left("steps"), left("elements")
        self._most_text = left("characters")
        self.properties = 0

    def step(self, size: int = 0) -> None:
        """Count one operation, whose result has this length."""
        self._steps += 1 + size // _PER_STEP
        if self._steps > self._most_steps:
            raise ExpressionError(excess("steps"))

    def element(self) -> None:
        """Count one element that is processed."""
        self._elements += 1
        if self._elements > self._most_elements:
            raise ExpressionError(excess("elements"))
        if not self._elements % GRAIN:
            check_time()

    def text(self, length: int) -> None:
        """Count text that was made."""
        self._text += length
        if self._text > self._most_text:
            raise ExpressionError(excess("characters"))

    def settle(self) -> None:
        """Take what the document has used from the budget."""
        for what, amount in (
            ("steps", self._steps), ("elements", self._elements), ("characters", self._text)
        ):  # fmt: skip
            charge(what, amount)


def check_length(length: int) -> None:
    """Refuse a text or list that would be too long, before it is made."""
    if length > MAX_LENGTH:
        raise ExpressionError(f"a text or list longer than {MAX_LENGTH} is refused")
