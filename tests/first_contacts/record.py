"""Records all first contacts in real PyBullet: `.oracle/bin/python -m tests.first_contacts.record`."""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any

from tests.first_contacts.cases import cases, follow

RECORDED = Path(__file__).with_name("pybullet.json")
# Of the distance, the normal, the point on the moving body, and the normal force.
DECIMALS = (6, 5, 5, 5, 5, 5, 5, 2)


def rounded(step: dict[str, Any]) -> list[Any]:
    """The number of a step and its points, with as many digits as are compared."""
    points = [
        [round(number, digits) for number, digits in zip(point, DECIMALS, strict=True)]
        for point in step["points"]
    ]
    return [step["step"], *points]


def recorded() -> dict[str, list[dict[str, Any]]]:
    """What was recorded, by the names of cases."""
    found = json.loads(RECORDED.read_text(encoding="utf-8"))
    return {
        name: [{"step": step, "points": points} for step, *points in steps] for name, steps in found.items()
    }


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    found = {case.name: [rounded(step) for step in follow(pybullet, case)] for case in cases()}
    lines = [f'"{name}":{json.dumps(steps, separators=(",", ":"))}' for name, steps in found.items()]
    RECORDED.write_text("{" + ",\n".join(lines) + "}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
