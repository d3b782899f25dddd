"""Asks real PyBullet what it makes of the test scenes, and writes its answers to `scenes_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/formats/record_scenes.py
"""

from __future__ import annotations

import importlib
import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

from scene_cases import CASES, DATA, REFUSED_SDF, ask

ANSWERS = Path(__file__).with_name("scenes_oracle.json")


def is_refused(load: Any, error: type[Exception], text: str, scratch: Path) -> bool:
    scratch.write_text(text, encoding="utf-8")
    try:
        load(str(scratch))
    except error:
        return True
    finally:
        scratch.unlink()
    return False


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    client = pybullet.connect(pybullet.DIRECT)
    scratch = DATA / "refused_by_pybullet.sdf"
    answers = {
        "pybullet": version("pybullet"),
        "cases": {case.name: ask(pybullet, case, client) for case in CASES},
        "refused sdf": {
            name: is_refused(pybullet.loadSDF, pybullet.error, text, scratch)
            for name, text in REFUSED_SDF.items()
        },
    }
    ANSWERS.write_text(json.dumps(answers, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
