"""Records contacts of two boxes, and stacks, in PyBullet: `python -m tests.collision.record_box_pairs`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.collision.box_pairs import follow, pairs, points, scenes

import pybullet as p

RECORDED = Path(__file__).with_name("box_pairs.json")


def main() -> None:
    """Writes the file."""
    p.connect(p.DIRECT)
    found: dict[str, Any] = {name: points(p, boxes) for name, boxes in pairs().items()}
    found.update({name: follow(p, build(p)) for name, build in scenes().items()})
    lines = [
        f"{json.dumps(name)}: {json.dumps([[round(number, 10) for number in row] for row in rows])}"
        for name, rows in found.items()
    ]
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
