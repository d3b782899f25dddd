"""Asks real PyBullet what it makes of the test robots, and writes its answers to `oracle.json` and
`limits_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/formats/record_oracle.py
"""

from __future__ import annotations

import importlib
import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

from load_cases import CASES, DATA, LIMITS, REFUSED, LoadCase
from recording import is_refused, plain

ANSWERS = Path(__file__).parent / "answers" / "oracle.json"
LIMITS_ANSWERS = Path(__file__).parent / "answers" / "limits_oracle.json"


def ask(pybullet: Any, case: LoadCase) -> dict[str, Any]:
    body = pybullet.loadURDF(
        str(DATA / case.file), flags=case.flags, globalScaling=case.scale, useFixedBase=case.fixed_base
    )
    count = pybullet.getNumJoints(body)
    answer = {
        "names": plain(pybullet.getBodyInfo(body)),
        "joints": [plain(pybullet.getJointInfo(body, index)) for index in range(count)],
        # The last two fields of getDynamicsInfo, body type and margin, do not come from the file.
        "dynamics": [plain(pybullet.getDynamicsInfo(body, index)[:10]) for index in range(-1, count)],
    }
    pybullet.resetSimulation()
    return answer


def ask_limits(pybullet: Any, text: str, scratch: Path) -> list[float]:
    """Lower and upper limit, effort and velocity of the first joint of a file."""
    scratch.write_text(text, encoding="utf-8")
    # A file of the same name is otherwise not read again.
    pybullet.setPhysicsEngineParameter(enableFileCaching=0)
    try:
        limits = pybullet.getJointInfo(pybullet.loadURDF(str(scratch)), 0)[8:12]
    finally:
        scratch.unlink()
        pybullet.resetSimulation()
    return plain(limits)


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    pybullet.connect(pybullet.DIRECT)
    scratch = DATA / "refused_by_pybullet.urdf"
    answers = {
        "pybullet": version("pybullet"),
        "cases": {case.name: ask(pybullet, case) for case in CASES},
        "refused": {
            name: is_refused(pybullet.loadURDF, pybullet.error, text, scratch)
            for name, text in REFUSED.items()
        },
    }
    limits = {name: ask_limits(pybullet, text, scratch) for name, text in LIMITS.items()}
    lines = (f"{json.dumps(name)}: {json.dumps(answer)}" for name, answer in limits.items())
    LIMITS_ANSWERS.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")
    ANSWERS.write_text(json.dumps(answers, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
