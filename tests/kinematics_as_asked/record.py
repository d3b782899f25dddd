"""Asks real PyBullet the questions of `cases`, and writes its answers to `oracle.json`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/kinematics_as_asked/record.py

With arguments it asks whichever module is installed more, also about the robots in another folder of data:

    .oracle/bin/python tests/kinematics_as_asked/record.py --data FOLDER --count 200 --write theirs.json
    python tests/kinematics_as_asked/record.py --data FOLDER --count 200 --write ours.json
    python tests/kinematics_as_asked/record.py --compare theirs.json ours.json
"""

from __future__ import annotations

import argparse
import importlib
import json
from pathlib import Path
from typing import Any

import numpy as np
from cases import ASSETS, COMBINATIONS, NUDGE, ROBOTS, SEVERAL, UNSTEADY, Asker, small_steps

ANSWERS = Path(__file__).with_name("oracle.json")


def ask(pybullet: Any, name: str, data: Path, count: int) -> dict[str, Any]:
    """Answers about a robot by combination, each with what a nudge of the targets changes."""
    asker = Asker(pybullet, name, data)
    result: dict[str, Any] = {}
    for combination in COMBINATIONS + SEVERAL:
        pairs = [[asker.answer(combination, seed, shift) for shift in (0.0, NUDGE)] for seed in range(count)]
        result[combination] = [
            [np.round(first, 12).tolist(), float(f"{np.abs(np.subtract(first, second)).max():.1e}")]
            for first, second in pairs
        ]
    result["small steps"] = [[small_steps(asker), 0.0]]
    asker.close()
    return result


def compare(theirs: dict[str, Any], ours: dict[str, Any]) -> None:
    """Print the largest differences, where PyBullet is steady and where it is not."""
    for name, combinations in theirs.items():
        for combination, pairs in combinations.items():
            apart: tuple[list[float], list[float]] = [], []
            for (answer, own), (other, _) in zip(pairs, ours[name][combination], strict=True):
                apart[own > UNSTEADY].append(float(np.abs(np.subtract(answer, other)).max()))
            steady, unsteady = (f"{max(some, default=0.0):.1e} of {len(some)}" for some in apart)
            print(f"{name:10} {combination:55} {steady}, unsteady {unsteady}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--data", type=Path, default=ASSETS)
    parser.add_argument("--count", type=int, default=1)
    parser.add_argument("--write", type=Path, default=ANSWERS)
    parser.add_argument("--robots", nargs="*", default=list(ROBOTS))
    parser.add_argument("--compare", type=Path, nargs=2)
    given = parser.parse_args()
    if given.compare:
        compare(*(json.loads(path.read_text(encoding="utf-8")) for path in given.compare))
        return
    pybullet: Any = importlib.import_module("pybullet")
    answers = {name: ask(pybullet, name, given.data, given.count) for name in given.robots}
    given.write.write_text(json.dumps(answers, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
