"""The files of tests that are to notice a mutant, the likeliest first."""

from __future__ import annotations

import re
from collections import Counter
from functools import cache
from pathlib import Path

from tests.rings import is_long
from tools.mutants.copies import ROOT
from tools.mutants.drawing import Drawn
from tools.nearest_tests import nearest_tests

_WORD = re.compile(r"[A-Za-z_]\w{3,}")


def near_files(drawn: Drawn) -> list[str]:
    """The files nearest to a mutant that `make test` runs; first those that share its rarest words."""
    files = [
        path
        for place in nearest_tests(drawn.file)
        for path in ([ROOT / place] if place.endswith(".py") else sorted((ROOT / place).rglob("test_*.py")))
        if not is_long(path)
    ]
    source = drawn.source
    wanted = set(_WORD.findall(_around(source, drawn.change.line))) | {Path(drawn.file).stem}
    counts = Counter(word for path in set(files) for word in _words(path))

    def likelihood(path: Path) -> float:
        return sum(1.0 / counts[word] for word in wanted & _words(path))

    ordered = sorted(dict.fromkeys(files), key=likelihood, reverse=True)
    return [path.relative_to(ROOT).as_posix() for path in ordered]


@cache
def _words(path: Path) -> frozenset[str]:
    """The words of a file of tests; those of its name count as well."""
    return frozenset(_WORD.findall(path.read_text(encoding="utf-8"))) | set(path.stem.split("_"))


def _around(source: str, line: int) -> str:
    """What is above a line, down to it, from the last line that isn't indented."""
    lines = source.splitlines()
    first = line - 1
    while first > 0 and (not lines[first].strip() or lines[first][0] in " \t)}"):
        first -= 1
    return "\n".join(lines[first:line])
