"""Pages as a stranger follows them: in an empty folder, with what the page says and nothing else.

Scripts that have a name above them are saved under it and started; other blocks are pasted into one session,
one after the other; and commands are typed.
"""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from tests.docs.blocks import ROOT, Block, blocks, run_blocks

FIRST_STEPS = ROOT / "README.md", ROOT / "docs" / "first-hour.md"
TUTORIALS = tuple(sorted((ROOT / "docs" / "tutorials").glob("*.md")))
# What scripts import, where it is not in each environment for developers.
_HEAVY = ("ray", "torch", "daqp", "gymnasium", "matplotlib", "jax")
# What needs a clone, a package index, or other machines.
_OTHERS = {"make", "pip", "ray"}
# What has no window, and an end of its own.
_UNBOUNDED = {"info", "record", "convert", "check"}
_LIMIT = 300.0


@dataclass(frozen=True)
class Step:
    """Something that a page says to do.

    Attributes:
        page: The page.
        name: What it is.
        words: What Python is started with.
    """

    page: Path
    name: str
    words: tuple[str, ...]


def save_scripts(pages: Iterable[Path], folder: Path) -> None:
    """Save the scripts of pages under their names, as each page tells."""
    for page in pages:
        for block in blocks(page):
            if block.title is not None:
                (folder / block.title).write_text(block.code, encoding="utf-8")


def steps(page: Path) -> Iterator[Step]:
    """What a page says to do: blocks at once, then scripts, then commands."""
    if any(run_blocks(page)):
        yield Step(page, "blocks", ("-m", "tests.docs.blocks", str(page)))
    typed = list(commands(page))
    started = {words[0] for words in typed}
    for block in blocks(page):
        if block.title is not None and block.title not in started and can_run(block):
            yield Step(page, block.title, ("-m", "tests.docs.bounded", block.title))
    for words in typed:
        bounded = words[:2] != ("-m", "carom") or words[2] not in _UNBOUNDED
        prefix = ("-m", "tests.docs.bounded") if bounded else ()
        if words[0].startswith("-") or all(map(can_run, titled(page, words[0]))):
            yield Step(page, shlex.join(words), (*prefix, *words))


def commands(page: Path) -> Iterator[tuple[str, ...]]:
    """What a page says to type behind `python`."""
    for block in blocks(page):
        if block.language != "sh":
            continue
        for line in block.text.replace("\\\n", " ").splitlines():
            program, *words = shlex.split(line, comments=True) or [""]
            if program == "python":
                yield tuple(words)
            elif program:
                assert program in _OTHERS, f"{page.name}: {line}"


def titled(page: Path, name: str) -> list[Block]:
    """The script of a name on a page."""
    return [block for block in blocks(page) if block.title == name]


def can_run(block: Block) -> bool:
    """Whether what a script imports is installed."""
    return all(find_spec(name) for name in _HEAVY if f"import {name}" in block.code)


def failure(step: Step, python: Path, folder: Path, path: str) -> str | None:
    """Do a step.

    Args:
        step: The step.
        python: The Python to do it with.
        folder: Where to do it.
        path: Where that Python finds modules besides.

    Returns:
        What went wrong, or None.
    """
    told = {"CI": "1", "XDG_RUNTIME_DIR": str(folder), "PYTHONPATH": path, "MPLBACKEND": "agg"}
    try:
        done = subprocess.run(
            [python, *step.words],
            cwd=folder,
            env=os.environ | told,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=_LIMIT,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"{step.page.name}: {step.name}: no end"
    # A script that Ctrl-C has ended, and that leaves it to Python, has the status of that signal.
    if done.returncode in (0, -signal.SIGINT):
        return None
    return f"{step.page.name}: {step.name}: {done.returncode}\n{(done.stdout + done.stderr)[-1500:]}"


def failures(
    pages: Iterable[Path], folder: Path, python: Path = Path(sys.executable), path: str = ""
) -> list[str]:
    """Follow pages, in their order, and say what went wrong.

    Args:
        pages: The pages.
        folder: An empty folder.
        python: The Python to do it with.
        path: Where that Python finds modules besides.
    """
    pages = list(pages)
    save_scripts(pages, folder)
    found = (failure(step, python, folder, path) for page in pages for step in steps(page))
    return [problem for problem in found if problem is not None]
