"""Asks real PyBullet about hulls and writes its answers to `hulls.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/pybullet/shapes/record_hulls.py
"""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

from hull_cases import CORNERS, TOUCHING, touches

ANSWERS = Path(__file__).with_name("hulls.json")


def ask(pybullet: Any, question: Callable[[Any], Any]) -> Any:
    """The answer in a world of its own."""
    pybullet.resetSimulation()
    return question(pybullet)


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    pybullet.connect(pybullet.DIRECT)
    answers = {
        "pybullet": version("pybullet"),
        "corners": {name: ask(pybullet, question) for name, question in CORNERS.items()},
        "touches": {name: ask(pybullet, lambda p, name=name: touches(p, name)) for name in TOUCHING},
    }
    ANSWERS.write_text(json.dumps(answers, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
