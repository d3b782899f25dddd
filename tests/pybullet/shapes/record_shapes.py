"""Asks real PyBullet about shapes and writes its answers to `shapes.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/pybullet/shapes/record_shapes.py
"""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from shape_cases import CASES, CORNER_CASES, MESHES, REFUSED, call

ANSWERS = Path(__file__).with_name("shapes.json")


def plain(value: Any) -> Any:
    """Tuples as lists, and of file names only the last part, as text."""
    if isinstance(value, bytes):
        return Path(value.decode("utf-8")).name
    if isinstance(value, (tuple, list)):
        return [plain(item) for item in value]
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    return value


def ask(pybullet: Any, question: Callable[[Any], Any]) -> Any:
    """The answer in a world of its own."""
    pybullet.resetSimulation()
    return plain(question(pybullet))


def refusal(pybullet: Any, function: str, arguments: dict[str, Any]) -> str | None:
    """The error of a call; None if there is none."""
    pybullet.resetSimulation()
    try:
        call(pybullet, function, arguments)
    except pybullet.error as error:
        return str(error)
    return None


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    pybullet.connect(pybullet.DIRECT)
    pybullet.setAdditionalSearchPath(str(MESHES))
    answers = {
        "pybullet": version("pybullet"),
        "cases": {name: ask(pybullet, question) for name, question in CASES.items()},
        "corners": {name: ask(pybullet, question) for name, question in CORNER_CASES.items()},
        "refused": {name: refusal(pybullet, *refused) for name, refused in REFUSED.items()},
    }
    ANSWERS.write_text(json.dumps(answers, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
