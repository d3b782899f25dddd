"""Records contacts of two boxes, and stacks, in PyBullet: `python -m tests.collision.record_box_pairs`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from tests.collision.box_pairs import (
    DROPS,
    STACKS,
    aligned_pairs,
    build_cubes,
    build_stack,
    follow,
    points,
    tilted_pairs,
)

import pybullet as p

RECORDED = Path(__file__).with_name("box_pairs.json")


def main() -> None:
    """Writes the file."""
    p.connect(p.DIRECT)
    found: dict[str, Any] = {
        name: points(p, boxes) for name, boxes in {**aligned_pairs(), **tilted_pairs()}.items()
    }
    for seed in STACKS:
        found[f"stack {seed}"] = follow(p, build_stack(p, seed))
    for drop in DROPS:
        found[f"cubes {drop}"] = follow(p, build_cubes(p, drop))
    lines = [
        f"{json.dumps(name)}: {json.dumps([[round(number, 10) for number in row] for row in rows])}"
        for name, rows in found.items()
    ]
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
