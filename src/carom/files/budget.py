"""The budget of reading a file: how much may be read, made and computed for it and all that it refers to.

One reading is one call: `World.load`, `loadURDF`, a texture, the mesh of a shape. What it takes is added up
over all files that it opens, and each reader asks before it takes memory in proportion to a number in a file.
The defaults are far above what robots need. `set_budget(vertices=10**9)` changes them for the process, and
the environment variable `CAROM_BUDGET="vertices=1e9,seconds=3600"` before it starts.

Nesting has limits of its own (`MAX_DEPTH`...), because the interpreter's stack ends there.
"""

from __future__ import annotations

import os
from contextvars import ContextVar
from dataclasses import dataclass, fields, replace
from math import inf
from pathlib import Path
from time import thread_time

from carom.errors import DescriptionError

VARIABLE = "CAROM_BUDGET"
"""The environment variable that sets limits, as `name=number`, with commas between them."""

GRAIN = 4096
"""How often loops ask for the time: once in so many turns."""


@dataclass(frozen=True, slots=True)
class Budget:
    """The most that one reading may take.

    Attributes:
        files: Files that are opened.
        includes: Robot files that others include or attach, directly or through others.
        bytes: Bytes of all files together.
        file_bytes: Bytes of one mesh, image or other file.
        document_bytes: Bytes of one robot file, of YAML or of materials.
        world_bytes: Bytes of one saved world.
        elements: Elements of all documents, copies by `<replicate>`, `<attach>` and macros included.
        vertices: Vertices and triangles of all meshes; a height counts as three.
        pixels: Pixels of all images.
        characters: Characters that macros of xacro make.
        steps: Operations of the expressions of xacro, and directory entries that patterns are compared with.
        seconds: Time of the processor [s].
    """

    files: int = 10_000
    includes: int = 512
    bytes: int = 8 << 30
    file_bytes: int = 1 << 30
    document_bytes: int = 64 << 20
    world_bytes: int = 4 << 30
    elements: int = 500_000
    vertices: int = 1 << 26
    pixels: int = 1 << 26
    characters: int = 16 << 20
    steps: int = 2_000_000
    seconds: float = 300.0


_WORDS = {
    "files": "files", "includes": "included files", "bytes": "bytes of all files", "file_bytes": "bytes",
    "document_bytes": "bytes", "world_bytes": "bytes", "elements": "elements",
    "vertices": "vertices and triangles", "pixels": "pixels", "characters": "characters of macros",
    "steps": "operations", "seconds": "seconds of the processor",
}  # fmt: skip


class BudgetError(DescriptionError):
    """Reading a file takes more than the budget; the message says which limit, and how to raise it."""


class Ledger:
    """What one reading has taken.

    Attributes:
        budget: The most that it may take.
        spent: Amounts so far, by the name of the limit.
        files: The files that are being read, the innermost last; None for what has no file.
        until: Time of the thread at which it ends [s].
    """

    __slots__ = ("budget", "files", "spent", "until")

    def __init__(self, budget: Budget) -> None:
        self.budget = budget
        self.spent: dict[str, int] = {}
        self.files: list[Path | None] = []
        self.until = thread_time() + budget.seconds


current: ContextVar[Ledger | None] = ContextVar("carom_reading", default=None)
"""The reading in progress, which `carom.files.boundary.reading` begins."""


def budget() -> Budget:
    """The budget of the reading in progress, or of the next one."""
    ledger = current.get()
    return _Kept.budget() if ledger is None else ledger.budget


def set_budget(**limits: float) -> Budget:
    """Change limits of the budget of every later reading in this process; returns the budget before.

    Args:
        limits: Numbers by the names of `Budget`; without any, all have their defaults again.

    Raises:
        ValueError: There is no such limit, or it is not a positive number.
    """
    before = _Kept.budget()
    _Kept.own = _changed(before if limits else Budget(), limits)
    return before


def charge(
    what: str,
    amount: int = 1,
    *,
    file: Path | None = None,
    line: int | None = None,
    element: str | None = None,
) -> None:
    """Take an amount from the budget, before the memory or work is spent.

    Args:
        what: A name of `Budget`.
        amount: How much.
        file: The file at fault, if it is not the one being read.
        line: Its line, if known.
        element: Its element, if known.

    Raises:
        BudgetError: The reading would take more than the limit.
    """
    ledger = current.get()
    if ledger is None:
        ledger = Ledger(_Kept.budget())
    spent = ledger.spent.get(what, 0) + amount
    if spent > getattr(ledger.budget, what):
        raise BudgetError(excess(what, spent), file=file or _file(ledger), line=line, element=element)
    ledger.spent[what] = spent
    if thread_time() > ledger.until:
        raise BudgetError(excess("seconds"), file=file or _file(ledger), line=line, element=element)


def check_size(what: str, amount: int, file: Path) -> None:
    """Raise `BudgetError` if one thing alone, such as a file, is larger than its limit."""
    if amount > getattr(budget(), what):
        raise BudgetError(excess(what, amount), file=file)


def left(what: str) -> int:
    """How much of a limit is left, for those who count by themselves and `charge` at the end."""
    ledger = current.get()
    if ledger is None:
        return getattr(_Kept.budget(), what)
    return getattr(ledger.budget, what) - ledger.spent.get(what, 0)


def check_time() -> None:
    """Raise `BudgetError` if the reading in progress has taken too long."""
    ledger = current.get()
    if ledger is not None and thread_time() > ledger.until:
        raise BudgetError(excess("seconds"), file=_file(ledger))


def excess(what: str, amount: float | None = None) -> str:
    """The message that a limit is exceeded, by this amount if it is known."""
    limit, words = getattr(budget(), what), _WORDS[what]
    problem = (
        f"it takes more than {limit} {words}"
        if amount is None
        else f"{amount} {words} are more than the {limit} accepted"
    )
    return f"{problem}; for a file that is right, call carom.files.budget.set_budget({what}=...) before"


def _file(ledger: Ledger) -> Path | None:
    return next((file for file in reversed(ledger.files) if file is not None), None)


def _changed(old: Budget, limits: dict[str, float]) -> Budget:
    for name, value in limits.items():
        if name not in _WORDS:
            known = ", ".join(field.name for field in fields(Budget))
            raise ValueError(f"the budget has no limit {name!r}; it has {known}")
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 < value < inf:
            raise ValueError(f"{name}={value!r}: a limit of the budget is a positive, finite number")
    # Limits are compared with whole numbers, which messages show.
    whole = {name: value if name == "seconds" else int(value) for name, value in limits.items()}
    return replace(old, **whole) if whole else old


class _Kept:
    """The budget of this process."""

    own: Budget | None = None

    @classmethod
    def budget(cls) -> Budget:
        """The budget; that of the environment until one is set."""
        if cls.own is None:
            cls.own = _changed(Budget(), _stated(os.environ.get(VARIABLE, "")))
        return cls.own


def _stated(text: str) -> dict[str, float]:
    """The limits in a text, by name."""
    limits: dict[str, float] = {}
    for part in filter(str.strip, text.split(",")):
        name, _, number = part.partition("=")
        try:
            limits[name.strip()] = float(number)
        except ValueError:
            raise ValueError(f"{VARIABLE}: {part.strip()!r} is not name=number") from None
    return limits
