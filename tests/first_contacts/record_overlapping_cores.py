"""Records contacts of overlapping cores: `python -m tests.first_contacts.record_overlapping_cores`."""

from __future__ import annotations

import json
from pathlib import Path

from tests.first_contacts.overlapping_cores import PAIRS, contacts

import pybullet as p

RECORDED = Path(__file__).with_name("overlapping_cores.json")


def main() -> None:
    """Writes the file."""
    p.connect(p.DIRECT)
    found = {pair: [[round(number, 10) for number in row] for row in contacts(p, pair)] for pair in PAIRS}
    lines = [f"{json.dumps(pair)}: {json.dumps(rows)}" for pair, rows in found.items()]
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
