"""Limits of time and memory for each damaged file, and child processes that are ended when one breaks them.

Files are read in child processes, a batch in each. The system ends a child whose file takes too much time of
the processor, also in a loop of C, and `faulthandler` says where it was; memory beyond the limit is an
exception. The child notes which file it is at, so that the parent can name it.
"""

from __future__ import annotations

import faulthandler
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.fuzz.memory import check_memory

from carom.files.budget import set_budget

SECONDS = 10.0
"""Time of the processor that a file may take, with a step of what it describes [s]."""
PATIENCE = 1800.0
"""Time after which a batch hangs that does not work [s]."""
BATCH = 1000
_SPACE = 6 << 30
BUDGET = {
    "bytes": 64 << 20, "elements": 30_000, "vertices": 1_000_000, "pixels": 1_000_000, "steps": 200_000,
    "characters": 1 << 20, "includes": 64, "seconds": 4.0,
}  # fmt: skip
"""The budget of reading while files are damaged: a tenth of what users have, for a tenth of the memory."""


def begin() -> None:
    """Set the limits of this process."""
    set_budget(**BUDGET)
    if sys.platform == "win32":
        return
    import resource

    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (_SPACE, hard))
    faulthandler.register(signal.SIGPROF, chain=True)


@contextmanager
def one_file(note: Path | None, number: int) -> Iterator[None]:
    """A context in which one file is read; `note` is where the parent looks for its number."""
    if note is not None:
        note.write_text(str(number), encoding="utf-8")
    if sys.platform == "win32":
        yield
        return
    signal.setitimer(signal.ITIMER_PROF, SECONDS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
    check_memory()


def in_children(command: list[str], kind: str, cases: int, seed: int) -> str | None:
    """Run so many cases in children; the name of the first that did not end well, and what it printed."""
    with TemporaryDirectory(prefix="carom-fuzz-") as folder:
        note = Path(folder, "case")
        for first in range(0, cases, BATCH):
            arguments = [
                *command, "--kinds", kind, "--seed", str(seed), "--first", str(first),
                "--cases", str(min(BATCH, cases - first)), "--note", str(note),
            ]  # fmt: skip
            try:
                done = subprocess.run(
                    arguments, capture_output=True, text=True, timeout=PATIENCE, check=False, errors="replace"
                )
                problem = f"status {done.returncode}\n{done.stderr[-6000:]}" if done.returncode else ""
                said = done.stdout.strip()
            except subprocess.TimeoutExpired:
                problem, said = f"it was not done after {PATIENCE:g} s", ""
            if problem:
                at = note.read_text(encoding="utf-8") if note.exists() else str(first)
                again = " ".join([*command, "--kinds", kind, "--seed", str(seed), "--first", at, "--cases 1"])
                return f"kind {kind}, seed {seed}, case {at}: {problem}\nagain: {again} --here"
            print(said, flush=True)
    return None
