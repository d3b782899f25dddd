"""Makes all calls with real PyBullet and records what comes of them: `make surface`.

Each call runs in a process of its own, since some end PyBullet's.
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import tempfile
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from .calls import CALLS
from .perform import Places, changed, tried, untouched

RECORDING = Path(__file__).with_name("oracle.json")


def alone(work: Callable[[], Any]) -> Any:
    """What work in a child process returns; None if that came to grief."""
    here, there = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(here)
        quiet = os.open(os.devnull, os.O_WRONLY)
        os.dup2(quiet, 1)
        os.dup2(quiet, 2)
        with os.fdopen(there, "w") as pipe:
            json.dump(work(), pipe)
        os._exit(0)
    os.close(there)
    with os.fdopen(here) as pipe:
        answer = pipe.read()
    _, status = os.waitpid(child, 0)
    return json.loads(answer) if status == 0 else None


def record(pybullet: Any, function: str) -> dict[str, Any]:
    """What comes of every call of a function."""
    calls = CALLS[function]
    outcomes: dict[str, Any] = {}
    before: Any = None
    for call in calls.each(function):
        with tempfile.TemporaryDirectory() as folder:
            places = Places(folder)
            if before is None:
                before = alone(lambda places=places: untouched(pybullet, calls, places))
            outcome = alone(lambda places=places, call=call: tried(pybullet, function, calls, call, places))
        if outcome is None:
            outcome = {"crashes": True}
        else:
            outcome["changes"] = changed(before, outcome.pop("seen"))
        outcomes[call.title] = outcome
    return outcomes


def main() -> None:
    """Record all functions, or those named on the command line."""
    pybullet: Any = importlib.import_module("pybullet")
    names = sys.argv[1:] or sorted(CALLS)
    old = json.loads(RECORDING.read_text()) if RECORDING.exists() and sys.argv[1:] else {}
    recording = {**old, "pybullet": version("pybullet")}
    for name in names:
        recording[name] = record(pybullet, name)
    lines = [f" {json.dumps(name)}: {json.dumps(recording[name])}" for name in sorted(recording)]
    RECORDING.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
