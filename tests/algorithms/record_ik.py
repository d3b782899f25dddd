"""Asks real PyBullet the questions of `ik_cases`, and writes its answers to `ik_oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/algorithms/record_ik.py

With arguments it asks whichever module is installed more questions, about the robots in another folder of data:

    .oracle/bin/python tests/algorithms/record_ik.py --data FOLDER --count 200 --write theirs.json
    python tests/algorithms/record_ik.py --data FOLDER --count 200 --write ours.json
    python tests/algorithms/record_ik.py --compare theirs.json ours.json
"""

from __future__ import annotations

import argparse
import importlib
import json
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import numpy as np
from ik_cases import ASSETS, COMBINATIONS, NUDGE, ROBOTS, SEVERAL, Asker, small_steps

ANSWERS = Path(__file__).with_name("ik_oracle.json")
KEPT = 3


def ask(pybullet: Any, name: str, data: Path, count: int) -> dict[str, Any]:
    """All answers about a robot: by combination pairs of the answer and that to nudged targets."""
    asker = Asker(pybullet, name, data)
    result: dict[str, Any] = {}
    for number, combination in enumerate(COMBINATIONS + SEVERAL):
        seeds = range(1000 * number, 1000 * number + count)
        result[combination] = [[asker.answer(combination, seed, shift) for shift in (0, NUDGE)] for seed in seeds]
    result["steps"] = [[small_steps(asker)] * 2]
    asker.close()
    return result


def differences(theirs: dict[str, Any], ours: dict[str, Any]) -> dict[str, str]:
    """For each combination: the largest difference, where PyBullet is steady and where it is not."""
    lines = {}
    for combination, pairs in theirs.items():
        if "+" in combination or combination in ours:
            apart, unsteady = [], []
            for (first, nudged), (answer, _) in zip(pairs, ours[combination], strict=True):
                own = np.abs(np.subtract(first, nudged)).max()
                difference = np.abs(np.subtract(first, answer)).max()
                (unsteady if own > 1e-10 else apart).append(difference)
            lines[combination] = (
                f"{max(apart, default=0.0):.1e} of {len(apart)}, unsteady {max(unsteady, default=0.0):.1e} "
                f"of {len(unsteady)}"
            )
    return lines


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=Path, default=ASSETS)
    parser.add_argument("--count", type=int, default=KEPT)
    parser.add_argument("--write", type=Path, default=ANSWERS)
    parser.add_argument("--robots", nargs="*", default=list(ROBOTS))
    parser.add_argument("--compare", type=Path, nargs=2)
    given = parser.parse_args()
    if given.compare:
        theirs, ours = (json.loads(path.read_text(encoding="utf-8")) for path in given.compare)
        for name in theirs["robots"]:
            for combination, line in differences(theirs["robots"][name], ours["robots"][name]).items():
                print(f"{name:10} {combination:55} {line}")
        return
    pybullet: Any = importlib.import_module("pybullet")
    start = time.perf_counter()
    robots = {name: ask(pybullet, name, given.data, given.count) for name in given.robots}
    print(f"{time.perf_counter() - start:.1f} s")
    try:
        number = version("pybullet")
    except PackageNotFoundError:
        number = "Carom"
    answers = {"pybullet": number, "robots": robots}
    given.write.write_text(json.dumps(answers, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
