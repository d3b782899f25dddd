"""Does all experiments in real PyBullet: `.oracle/bin/python -m tests.soft.beside.record`.

Each is done in a process of its own, for what PyBullet makes of a soft body depends on what it has simulated
before; and again at four times the rate, until two rates in a row agree: that is where the body would be if
the time step were no matter. PyBullet is stable in a case if the first two agree.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from tests.soft.beside.cases import CASES, Case
from tests.soft.beside.measure import perform

RECORDED = Path(__file__).with_name("pybullet.json")
_FACTOR = 4
_MOST = 4**4
# Two rates agree if their figures differ by less than this share.
_AGREE = 0.02
_LONGEST = 300.0
_DIGITS = 9


def _figure(case: Case, factor: int) -> float | None:
    """What comes of an experiment in a new process at a multiple of its rate; None if the body explodes."""
    command = [sys.executable, "-m", "tests.soft.beside.record", "--case", case.name, "--factor", str(factor)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_LONGEST, check=True)
    return json.loads(done.stdout.splitlines()[-1])


def _agree(first: float | None, second: float | None) -> bool:
    return first is not None and second is not None and abs(second - first) <= _AGREE * abs(second)


def _record(case: Case) -> dict[str, Any]:
    figures = [_figure(case, 1)]
    factor = 1
    while factor < _MOST and (len(figures) < 2 or not _agree(figures[-2], figures[-1])):
        factor *= _FACTOR
        figures.append(_figure(case, factor))
    settled = figures[-1] if _agree(figures[-2], figures[-1]) else None
    return {"figure": figures[0], "stable": len(figures) == 2, "settled": settled}


def _short(value: float | None) -> float | None:
    return None if value is None else float(f"{value:.{_DIGITS}g}")


def main() -> None:
    """Record all cases or those that are missing, or do the experiment of one."""
    parser = argparse.ArgumentParser(description="Record what PyBullet makes of soft bodies.")
    parser.add_argument("--case", choices=CASES)
    parser.add_argument("--factor", type=int, default=1)
    parser.add_argument("--missing", action="store_true", help="keep what is recorded of the other cases")
    arguments = parser.parse_args()
    if arguments.case:
        pybullet: Any = importlib.import_module("pybullet")
        case = CASES[arguments.case]
        rate = arguments.factor * case.options.get("rate", 240)
        result = perform(pybullet, case.experiment, case.options | {"rate": rate})
        print(json.dumps(_short(result.figure)))
        return
    known = json.loads(RECORDED.read_text(encoding="utf-8")) if arguments.missing else {}
    wanted = [case for name, case in CASES.items() if name not in known]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = known | {case.name: it for case, it in zip(wanted, pool.map(_record, wanted), strict=True)}
    lines = [f"{json.dumps(name)}: {json.dumps(found[name])}" for name in CASES]
    RECORDED.write_text("{\n" + ",\n".join(lines) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
