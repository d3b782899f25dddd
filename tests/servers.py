"""Processes for tests of physics servers."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING

from tests.patience import PATIENCE

if TYPE_CHECKING:
    from typing_extensions import Self

SOURCE = Path(__file__).parents[1] / "src"

# Reads key and options of servers from its input, one a line, and opens and closes them.
_SERVERS = """
import sys
import pybullet as p

clients = {}
for line in sys.stdin:
    order, key, *options = line.split()
    if order == "open":
        clients[key] = p.connect(p.SHARED_MEMORY_SERVER, key=int(key), options=" ".join(options))
    else:
        p.disconnect(clients.pop(key))
    print("done", flush=True)
"""


def environment(**more: str) -> dict[str, str]:
    """That of a process that is to import Carom."""
    return {**os.environ, "PYTHONPATH": str(SOURCE), **more}


class Process:
    """A Python process with pipes, killed at the end of a `with` block."""

    def __init__(self, code: str, arguments: Sequence[str] = ()) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-c", code, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=environment(),
            text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.wait()
        for pipe in (self.process.stdin, self.process.stdout):
            if pipe is not None:
                pipe.close()

    def tell(self, line: str) -> None:
        """Sends it a line."""
        pipe = _pipe(self.process.stdin)
        pipe.write(line + "\n")
        pipe.flush()

    def hear(self) -> str:
        """A line of its output."""
        return _pipe(self.process.stdout).readline().strip()

    def ask(self, line: str) -> str:
        """Sends it a line and returns the answer."""
        self.tell(line)
        return self.hear()

    def end(self) -> int:
        """Waits until it has ended by itself; returns its exit status."""
        _pipe(self.process.stdin).close()
        return self.process.wait(timeout=PATIENCE)


class Servers(Process):
    """A process with any number of physics servers."""

    def __init__(self) -> None:
        super().__init__(_SERVERS)

    def open(self, key: int, options: str = "") -> None:
        """Opens a server with a new world."""
        assert self.ask(f"open {key} {options}") == "done"

    def close(self, key: int) -> None:
        """Closes it."""
        assert self.ask(f"close {key}") == "done"


def _pipe(pipe: IO[str] | None) -> IO[str]:
    assert pipe is not None
    return pipe
