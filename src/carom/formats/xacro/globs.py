"""Files whose paths match a pattern, found within a budget: a short pattern can stand for a whole disc."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from fnmatch import translate

_MAGIC = re.compile(r"[*?\[]")


def has_magic(name: str) -> bool:
    """Whether a name is a pattern, with `*`, `?` or `[`."""
    return _MAGIC.search(name) is not None


def matches(pattern: str, step: Callable[[], None]) -> list[str]:
    """The regular files that match a pattern, sorted, as `glob.glob` finds them.

    Args:
        pattern: A path; each of its parts may have `*`, `?` and `[...]`, which match no leading dot.
        step: Called for each entry of a folder that is looked at; it may raise an error to end the search.
    """
    drive, rest = os.path.splitdrive(pattern)
    root = os.sep if rest.startswith(("/", os.sep)) else ""
    parts = [part for part in re.split(r"[/\\]" if os.sep == "\\" else "/", rest) if part]
    return sorted(path for path in _below(drive + root, parts, step) if os.path.isfile(path))


def _below(folder: str, parts: list[str], step: Callable[[], None]) -> Iterator[str]:
    """The paths below a folder that match these parts, one each for every level."""
    if not parts:
        yield folder
        return
    part, rest = parts[0], parts[1:]
    step()
    if not has_magic(part):
        path = os.path.join(folder, part)
        if os.path.lexists(path):
            yield from _below(path, rest, step)
        return
    fits = re.compile(translate(part)).match
    for name in _names(folder, step):
        if fits(name) and (part.startswith(".") or not name.startswith(".")):
            yield from _below(os.path.join(folder, name), rest, step)


def _names(folder: str, step: Callable[[], None]) -> Iterator[str]:
    try:
        with os.scandir(folder or os.curdir) as entries:
            for entry in entries:
                step()
                yield entry.name
    except OSError:
        return
