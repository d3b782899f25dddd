"""Asks real PyBullet what it makes of the test scenes, and writes its answers to `scenes_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/formats/record_scenes.py
"""

from __future__ import annotations

import importlib
import json
from concurrent.futures import ProcessPoolExecutor
from importlib.metadata import version
from pathlib import Path
from typing import Any

from recording import is_refused
from scene_cases import CASES, DATA, REFUSED_SDF, SceneCase, ask

ANSWERS = Path(__file__).parent / "answers" / "scenes_oracle.json"


def ask_anew(case: SceneCase) -> Any:
    """The answers of a new process: PyBullet counts the names it makes up from one file to the next."""
    with ProcessPoolExecutor(1) as pool:
        return pool.submit(ask_alone, case).result()


def ask_alone(case: SceneCase) -> Any:
    pybullet: Any = importlib.import_module("pybullet")
    return ask(pybullet, case, pybullet.connect(pybullet.DIRECT))


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    pybullet.connect(pybullet.DIRECT)
    scratch = DATA / "refused_by_pybullet.sdf"
    answers = {
        "pybullet": version("pybullet"),
        "cases": {case.name: ask_anew(case) for case in CASES},
        "refused sdf": {
            name: is_refused(pybullet.loadSDF, pybullet.error, text, scratch)
            for name, text in REFUSED_SDF.items()
        },
    }
    ANSWERS.write_text(json.dumps(answers, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
