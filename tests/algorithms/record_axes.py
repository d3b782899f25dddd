"""Asks real PyBullet the questions of `axis_cases`, and writes its answers to `axes_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/algorithms/record_axes.py
"""

from __future__ import annotations

import importlib
import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

from axis_cases import ARMS, ask

ANSWERS = Path(__file__).with_name("axes_oracle.json")


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    answers = {"pybullet": version("pybullet"), **{name: ask(pybullet, arm) for name, arm in ARMS.items()}}
    ANSWERS.write_text(json.dumps(answers, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
