"""Asks real PyBullet the questions of `reach_cases`, and writes its answers to `reach_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/algorithms/record_reach.py
"""

from __future__ import annotations

import importlib
import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

from reach_cases import ANSWERS_KEPT, ARMS, WAYS, Reach, single_calls, two_ends

ANSWERS = Path(__file__).with_name("reach_oracle.json")


def ask(pybullet: Any, name: str) -> dict[str, Any]:
    reach = Reach(pybullet, ARMS[name])
    targets = reach.targets(max(way.poses for way in WAYS.values()))
    ways = {}
    for title, way in WAYS.items():
        answers = [reach.ask(way, target) for target in targets[: way.poses]]
        ways[title] = {
            "reached": sum(
                reach.reached(way, target, answer) for target, answer in zip(targets, answers, strict=False)
            ),
            "within limits": sum(reach.within_limits(answer) for answer in answers),
            "answers": answers[:ANSWERS_KEPT],
        }
    calls = {}
    for title, arguments in single_calls(reach).items():
        reach.place(reach.home)
        calls[title] = pybullet.calculateInverseKinematics(
            reach.body, physicsClientId=reach.client, **arguments
        )
    arguments = two_ends(reach)
    reach.place(reach.home)
    two = pybullet.calculateInverseKinematics2(reach.body, physicsClientId=reach.client, **arguments)
    reach.close()
    return {"ways": ways, "calls": calls, "two ends": two}


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    answers = {"pybullet": version("pybullet"), **{name: ask(pybullet, name) for name in ARMS}}
    ANSWERS.write_text(json.dumps(answers, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
