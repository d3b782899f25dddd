"""The figures recorded from the original assets by tools/assets/record_facts.py."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pybullet_data

FOLDER = Path(__file__).parent / "facts"
NAMES = sorted(path.stem for path in FOLDER.glob("*.json"))
DATA = Path(pybullet_data.getDataPath())


def facts(name: str) -> dict[str, Any]:
    """Everything recorded of one asset."""
    return json.loads((FOLDER / f"{name}.json").read_text())
