"""The figures recorded from the original assets by tools/assets/record_facts.py."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import pybullet_data

FOLDER = Path(__file__).parent / "facts"
DATA = Path(pybullet_data.getDataPath())


@cache
def bodies() -> dict[str, dict[str, Any]]:
    """Everything recorded of each body: by the name of its file, and its number if it is not the first."""
    found: dict[str, dict[str, Any]] = {}
    for path in sorted(FOLDER.glob("*.json")):
        for number, fact in enumerate(json.loads(path.read_text())):
            found[f"{path.stem}-{number}" if number else path.stem] = fact | {"number": number}
    return found


NAMES = list(bodies())


def facts(name: str) -> dict[str, Any]:
    """Everything recorded of one body."""
    return bodies()[name]
