"""Differences that docs/differences states: they are counted, and not reported.

Each is recognised by what differs and by what the program has done before. A new one belongs here only
with the words that docs/differences has about it, or with a reason why it is no difference.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tools.differ.compare import Difference
from tools.differ.programs import Call


@dataclass(frozen=True)
class Seen:
    """A difference, and the calls before it."""

    difference: Difference
    before: Sequence[Call]

    @property
    def call(self) -> Call:
        """The call whose result differs."""
        return self.before[-1]

    def differs(self, *beginnings: str) -> bool:
        """Whether the signature begins with one of some texts."""
        return self.difference.signature.startswith(beginnings)

    def has(self, function: str, keyword: str = "") -> bool:
        """Whether a function was called before, with a keyword."""
        return any(call["f"] == function and (not keyword or keyword in call["k"]) for call in self.before)

    def loads(self, ending: str) -> bool:
        """Whether a file of some kind was loaded."""
        return any(
            call["f"].startswith("load") and str(call["a"][:1]).endswith(f"{ending}']")
            for call in self.before
        )


@dataclass(frozen=True)
class Known:
    """A known difference.

    Attributes:
        says: Words of docs/differences.
        recognises: Whether a difference is one of this kind.
    """

    says: str
    recognises: Callable[[Seen], bool]


KNOWN: tuple[Known, ...] = ()


def statement(calls: Sequence[Call], difference: Difference) -> str | None:
    """The words of docs/differences about a difference; None if there are none."""
    seen = Seen(difference, calls[: difference.call + 1])
    return next((known.says for known in KNOWN if known.recognises(seen)), None)
