"""Names of mutants, by what they change: they stay when other lines of a file come and go."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator

from tools.mutants.change import Change

_PYTHON = re.compile(r"\s*(?:async def|def|class)\s+(\w+)")
_OTHER = re.compile(r"\s*(?:(?:export|static|async|struct|class|function|inline)\s+)*[^=;]*?([\w~]+)\s*[({]")
_NO_NAMES = ("if", "for", "while", "switch", "catch", "else", "do", "try")


def named(file: str, source: str, changes: Iterable[Change]) -> Iterator[tuple[str, Change]]:
    """Changes with their names: the file, the function, the line, and what is there before and after.

    Changes that are alike in all of these are numbered.

    Args:
        file: Path from the root.
        source: Its text.
        changes: What may be changed there, in the order of its text.
    """
    lines = source.splitlines()
    counts: Counter[str] = Counter()
    for change in changes:
        place = _function(lines, change.line, _PYTHON if file.endswith(".py") else _OTHER)
        text = _brief(lines[change.line - 1])
        name = f"{file} {place}: {text} | {_brief(source[change.start : change.end])} -> {_brief(change.new)}"
        counts[name] += 1
        yield name if counts[name] == 1 else f"{name} ({counts[name]})", change


def _function(lines: list[str], line: int, pattern: re.Pattern[str]) -> str:
    """The classes and functions around a line, by its indentation and that of the lines above."""
    found: list[str] = []
    depth = _depth(lines[line - 1])
    for text in reversed(lines[: line - 1]):
        # What closes the list of arguments stands as far to the left as what opens it.
        if not text.strip() or text.lstrip()[0] in ")#}/" or _depth(text) >= depth:
            continue
        depth = _depth(text)
        match = pattern.match(text)
        if match and match[1] not in _NO_NAMES:
            found.append(match[1])
        if not depth:
            break
    return ".".join(reversed(found))


def _depth(text: str) -> int:
    return len(text) - len(text.lstrip())


def _brief(text: str) -> str:
    words = " ".join(text.split())
    return words if len(words) <= 60 else f"{words[:57]}..."
