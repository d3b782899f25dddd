"""Performs programs as `perform.py` does, each with the fault that its order names, if any."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[3]))

from tools.differ import perform
from tools.differ.faults.spoiling import Spoiled
from tools.differ.faults.table import FAULTS

import pybullet


def in_a_process(order: dict[str, Any]) -> dict[str, Any]:
    """What came of a program."""
    fault = FAULTS.get(order.get("fault", ""))
    perform.p = Spoiled(pybullet, fault.changes(pybullet)) if fault else pybullet
    return perform.in_a_process(order)


if __name__ == "__main__":
    perform.serve(in_a_process)
