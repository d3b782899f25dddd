"""Pieces of the long checks: commands that take minutes at most, each with what happened when it last ran."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event

SEED = "{seed}"
"""In a piece's arguments: the seed of a run."""
_PERIOD = 0.05
# Seeds of repeated runs of a piece are so far apart: more than a part has pieces.
_SEEDS_APART = 10_000


@dataclass(frozen=True)
class Piece:
    """A command that checks something.

    Attributes:
        part: The part it belongs to.
        name: What it is called within its part.
        arguments: Of the Python interpreter; `{seed}` stands for the seed.
        first_seed: Seed of its first run.
        environment: Environment variables it needs.
        passing: The statuses to end with that count as passed.
    """

    part: str
    name: str
    arguments: tuple[str, ...]
    first_seed: int = 0
    environment: Mapping[str, str] = field(default_factory=dict)
    passing: tuple[int, ...] = (0,)

    @property
    def key(self) -> str:
        """Its name among all pieces."""
        return f"{self.part}: {self.name}"

    def command(self, passes: int) -> list[str]:
        """What to run after so many runs that passed: a run that failed is repeated with the same seed."""
        seed = str(self.first_seed + passes * _SEEDS_APART)
        return [sys.executable, *(argument.replace(SEED, seed) for argument in self.arguments)]


@dataclass(frozen=True)
class Ran:
    """What came of a run.

    Attributes:
        passed: Whether it ended with a status that is passing; None if it was ended before.
        seconds: How long it took.
        output: All that it printed.
    """

    passed: bool | None
    seconds: float
    output: str


def run_piece(piece: Piece, passes: int, folder: Path, end: Event) -> Ran:
    """Run a piece in a folder until it ends, or until the event is set, which ends all it has started.

    Args:
        piece: What to run.
        passes: How often it has passed before.
        folder: Where to run it.
        end: Ends it before its time.
    """
    began = time.monotonic()
    # What a piece that is ended leaves behind is in a folder that goes with it.
    with tempfile.TemporaryDirectory(prefix="carom-thorough-", ignore_cleanup_errors=True) as own:
        printed = Path(own) / "printed"
        with printed.open("wb") as stream:
            process = subprocess.Popen(
                piece.command(passes),
                cwd=folder,
                env={**os.environ, "TMPDIR": own, "TEMP": own, **piece.environment},
                stdin=subprocess.DEVNULL,
                stdout=stream,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            )
            try:
                ended = _wait(process, end)
            finally:
                _end(process, own)
        output = printed.read_text(encoding="utf-8", errors="replace")
    passed = process.returncode in piece.passing if ended else None
    return Ran(passed, time.monotonic() - began, output)


def _wait(process: subprocess.Popen[bytes], end: Event) -> bool:
    """Whether the process has ended by itself."""
    while process.poll() is None:
        if end.wait(_PERIOD):
            return process.poll() is not None
    return True


def _end(process: subprocess.Popen[bytes], own: str) -> None:
    """End a process and all it has started: its group, and those with the same folder for temporary files."""
    if os.name == "posix":
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    elif process.poll() is None:
        process.kill()
    process.wait()
    for left in _with_folder(own):
        with suppress(ProcessLookupError):
            os.kill(left, signal.SIGKILL)


def _with_folder(own: str) -> list[int]:
    """Processes whose folder for temporary files is this one; only Linux tells."""
    named = f"TMPDIR={own}".encode()
    found = []
    for told in Path("/proc").glob("[0-9]*/environ"):
        with suppress(OSError):
            if named in told.read_bytes().split(b"\0"):
                found.append(int(told.parent.name))
    return found
