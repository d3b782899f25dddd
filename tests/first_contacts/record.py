"""Records all first contacts in real PyBullet: `.oracle/bin/python -m tests.first_contacts.record`."""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any

from tests.first_contacts.cases import cases, follow

RECORDED = Path(__file__).with_name("pybullet.json")
DIGITS = 9


def rounded(value: Any) -> Any:
    """Numbers with as many digits as are compared."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, list):
        return [rounded(item) for item in value]
    return {key: rounded(item) for key, item in value.items()} if isinstance(value, dict) else value


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    found = {case.name: rounded(follow(pybullet, case)) for case in cases()}
    RECORDED.write_text(json.dumps(found, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
