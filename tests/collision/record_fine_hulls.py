"""Records how fine hulls roll and walk in PyBullet: `python -m tests.collision.record_fine_hulls`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.collision.fine_hulls import GROUNDS, HULLS, roll, walk

import pybullet as p

RECORDED = Path(__file__).with_name("fine_hulls.json")


def main() -> None:
    """Writes the file."""
    p.connect(p.DIRECT)
    motions: dict[str, Any] = {}
    for hull in HULLS:
        for ground in GROUNDS:
            p.resetSimulation()
            motions[f"{hull} on {ground}"] = roll(p, hull, ground)
    p.resetSimulation()
    motions["walk"] = walk(p)
    lines = [
        f'"{name}": {json.dumps([[round(number, 7) for number in row] for row in rows])}'
        for name, rows in motions.items()
    ]
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
