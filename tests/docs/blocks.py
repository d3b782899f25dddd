"""The code blocks of the documentation, and how they are run.

Pages say what readers do not see in comments of HTML:

- `<!-- run first: ... -->`: Python that is run before the next block, such as imports that go without saying.
- `<!-- needs: av -->`: the next block is run only where this module is installed.
- `<!-- not run: ... -->`: the next block is not run, for this reason.

`python -m tests.docs.blocks PAGE` runs the blocks of a page one after the other, which share their names.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"])
_PIECE = re.compile(
    r"^<!-- (?P<kind>run first|needs|not run):(?P<note>.*?)-->"
    r"|^```(?P<language>\w+)(?P<info>[^\n]*)\n(?P<text>.*?)^```\s*$",
    re.MULTILINE | re.DOTALL,
)
_TITLE = re.compile(r'title="([\w.]+)"')
_EXAMPLE = re.compile(r'--8<-- "examples/(\w+)\.py"')


@dataclass(frozen=True)
class Block:
    """A code block.

    Attributes:
        language: What is written behind its fence.
        text: The code.
        line: Number of lines of the page above it.
        first: Code to be run before it, with lines above it.
        needs: Modules it needs beside those of the package.
        reason: Why it is not run; None if it is.
        title: The name that readers save it under; None if they do not.
    """

    language: str
    text: str
    line: int
    first: tuple[tuple[str, int], ...]
    needs: tuple[str, ...]
    reason: str | None
    title: str | None = None

    @property
    def code(self) -> str:
        """The code that the site shows."""
        if self.example is None:
            return self.text
        return (ROOT / "examples" / f"{self.example}.py").read_text(encoding="utf-8")

    @property
    def example(self) -> str | None:
        """Name of the example that is shown here, if any."""
        found = _EXAMPLE.fullmatch(self.text.strip())
        return found and found[1]


def blocks(page: Path) -> Iterator[Block]:
    """The code blocks of a page, from top to bottom."""
    text = page.read_text(encoding="utf-8")
    first: list[tuple[str, int]] = []
    needs: list[str] = []
    reason: str | None = None
    for piece in _PIECE.finditer(text):
        kind, note = piece["kind"], piece["note"]
        if kind == "run first":
            first.append((note, text.count("\n", 0, piece.start("note"))))
        elif kind == "needs":
            needs += note.split()
        elif kind == "not run":
            reason = note.strip()
        else:
            line = text.count("\n", 0, piece.start("text"))
            title = _TITLE.search(piece["info"])
            name = title and title[1]
            yield Block(piece["language"], piece["text"], line, tuple(first), tuple(needs), reason, name)
            first, needs, reason = [], [], None


def to_run(page: Path) -> list[Block]:
    """The blocks of a page that are run as they stand here; examples have tests of their own."""
    return [
        block
        for block in blocks(page)
        if block.language == "python" and block.example is None and block.reason is None
    ]


def run_blocks(page: Path) -> list[Block]:
    """The blocks of a page that are pasted into a session: those that are not saved as scripts."""
    return [block for block in to_run(page) if block.title is None]


def run(page: Path) -> None:
    """Runs the blocks of a page in this process, in the present directory, with Esc after a while."""
    from tests.docs.bounded import press_esc

    press_esc()
    names: dict[str, object] = {"__name__": "__main__"}
    for block in run_blocks(page):
        if not all(map(find_spec, block.needs)):
            continue
        for text, line in (*block.first, (block.text, block.line)):
            # Tracebacks then have the numbers of the page's lines.
            exec(compile("\n" * line + text, page, "exec"), names)


if __name__ == "__main__":
    run(Path(sys.argv[1]))
