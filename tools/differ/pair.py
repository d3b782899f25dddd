"""A pair of interpreters, with real PyBullet and with Carom, which perform the same programs."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypedDict

from tools.differ.programs import Call

ROOT = Path(__file__).parents[2]
ORACLE = ROOT / ".oracle" / "bin" / "python"
_SECONDS = 20.0


class Outcome(TypedDict):
    """What came of a program: results of its calls, as `perform.py` has them, and how its process died."""

    results: list[Any]
    died: str | None


class Server:
    """One interpreter that performs programs.

    Args:
        python: The interpreter.
        data: The folder that files are searched in.
        warm: Files that are loaded once before.
        tree: The checkout whose `src` has the module `pybullet`; that of the interpreter if left out.
        spoils: Whether orders may name faults (`faults/serve.py`); real PyBullet has none.
    """

    def __init__(
        self,
        python: str | Path,
        data: str,
        warm: Sequence[str] = (),
        *,
        tree: Path | None = None,
        spoils: bool = False,
    ) -> None:
        script = Path(__file__).parent / ("faults/serve.py" if spoils else "perform.py")
        self._data = data
        self._process = subprocess.Popen(
            [str(python), "-u", str(script)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            cwd=tempfile.gettempdir(),
            env=environment_of(tree),
        )
        self._send({"warm": list(warm), "data": data})
        self.answer()

    def order(self, calls: Sequence[Call], seconds: float = _SECONDS, fault: str = "") -> None:
        """Let a program be performed, for so many seconds at most and with a fault; `answer` waits for it."""
        self._send({"calls": calls, "data": self._data, "timeout": seconds, "fault": fault})

    def answer(self) -> Outcome:
        """What came of the program that was ordered.

        Raises:
            RuntimeError: The interpreter has ended.
        """
        assert self._process.stdout
        line = self._process.stdout.readline()
        if not line:
            raise RuntimeError(f"{self._process.args!r} ended with status {self._process.wait()}")
        return json.loads(line)

    def close(self) -> None:
        """End the interpreter."""
        assert self._process.stdin
        assert self._process.stdout
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait()

    def _send(self, order: dict[str, Any]) -> None:
        assert self._process.stdin
        self._process.stdin.write(json.dumps(order) + "\n")
        self._process.stdin.flush()


class Pair:
    """Both interpreters; files are PyBullet's own for both.

    Args:
        oracle: The interpreter with real PyBullet.
        warm: Files that are loaded once before.
        tree: The checkout that Carom is of; the one that these tools are in if left out.
        spoils: Whether faults may be put into Carom.
    """

    def __init__(
        self, oracle: Path = ORACLE, warm: Sequence[str] = (), *, tree: Path = ROOT, spoils: bool = False
    ) -> None:
        if not oracle.exists():
            raise FileNotFoundError(f"there is no {oracle}; `make oracle` makes it")
        data = data_of(oracle)
        self.oracle = Server(oracle, data, warm)
        self.carom = Server(sys.executable, data, warm, tree=tree, spoils=spoils)
        self._afresh: Server | None = None
        self._new = (oracle, data)

    def run(self, calls: Sequence[Call], seconds: float = _SECONDS) -> tuple[Outcome, Outcome]:
        """What came of a program in PyBullet, and in Carom, performed at the same time."""
        self.oracle.order(calls, seconds)
        self.carom.order(calls, seconds)
        return self.oracle.answer(), self.carom.answer()

    def afresh(self) -> Server:
        """Real PyBullet in an interpreter that has loaded nothing before."""
        if self._afresh is None:
            self._afresh = Server(*self._new)
        return self._afresh

    def close(self) -> None:
        """End the interpreters."""
        if self._afresh is not None:
            self._afresh.close()
        self.oracle.close()
        self.carom.close()


def environment_of(tree: Path | None) -> dict[str, str]:
    """The environment without a path to Carom's sources, which would hide the real module, or with one."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    return environment if tree is None else {**environment, "PYTHONPATH": str(tree / "src")}


def data_of(python: Path) -> str:
    """The folder of an interpreter's `pybullet_data`."""
    code = "import pybullet_data; print(pybullet_data.getDataPath())"
    command = [str(python), "-c", code]
    done = subprocess.run(command, env=environment_of(None), capture_output=True, text=True, check=True)
    return done.stdout.strip()
