"""One small change of a source."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Change:
    """Another text for a part of a source.

    Attributes:
        start: Index of the first character that is replaced.
        end: Index behind the last one.
        new: What stands there instead.
        kind: `operator`, `constant`, `branch` or `statement`.
        line: Its line, from 1.
    """

    start: int
    end: int
    new: str
    kind: str
    line: int

    def made(self, source: str) -> str:
        """The source with the change."""
        return source[: self.start] + self.new + source[self.end :]
