"""Times Carom against PyBullet: medians, ratios, and whether they are what we want.

    python benchmarks/run.py [--oracle .oracle/bin/python] [--mujoco .mujoco/bin/python] [--repetitions 5]

Every engine has an interpreter and processes of its own. The engines take turns at every case, so
that a busy moment of the machine hits them alike; a figure is the median over the turns. The exit
code does not depend on the figures.
"""

from __future__ import annotations

import argparse
import json
import platform
import statistics
import sys
from collections import defaultdict
from contextlib import ExitStack
from pathlib import Path

from cases import COLD_BUILD, IN_PROCESS, STARTS, Case
from engines import ROOT, Engine, original_data_directory

OURS, REFERENCE = "Carom", "PyBullet"
MARKS = ("<!-- figures -->", "<!-- end of figures -->")

Medians = dict[str, dict[str, float]]


def measure(engines: list[Engine], cases: list[str], repetitions: int, seconds: float, data: str) -> Medians:
    """Median seconds by case and engine, the engines taking turns at every case."""
    samples: dict[str, dict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    keys = [case.key for case in IN_PROCESS if case.key in cases]
    for repetition in range(repetitions):
        print(f"turn {repetition + 1} of {repetitions}", file=sys.stderr, flush=True)
        with ExitStack() as stack:
            workers = {
                engine.name: stack.enter_context(engine.worker(seconds, data)) for engine in engines if keys
            }
            for key in keys:
                for name, worker in workers.items():
                    value = worker.time(key)
                    if value is not None:
                        samples[key][name].append(value)
        for case in STARTS:
            for engine in engines:
                if engine.runs_scripts and case.key in cases:
                    samples[case.key][engine.name].append(engine.time_start(case.key))
    return {
        key: {name: statistics.median(values) for name, values in by_engine.items()}
        for key, by_engine in samples.items()
    }


def verdict(case: Case, times: dict[str, float]) -> tuple[str, str]:
    """What we want of a case, and whether it is so."""
    ours, theirs = times.get(OURS), times.get(REFERENCE)
    if case.seconds is not None:
        met = None if ours is None else ours <= case.seconds
        return f"≤ {case.seconds:g} s", "" if met is None else "PASS" if met else "FAIL"
    if case.slowdown is not None:
        met = None if ours is None or theirs is None else ours <= case.slowdown * theirs
        return f"≤ {case.slowdown:g}× PyBullet", "" if met is None else "PASS" if met else "FAIL"
    if case.speedup is not None:
        met = None if ours is None or theirs is None else theirs / ours >= case.speedup
        wanted = f"≥ {case.speedup:g}×"
        if case.no_slower_than is not None:
            wanted += f", ≤ {case.no_slower_than}"
            limit = times.get(case.no_slower_than)
            if met and ours is not None and limit is not None:
                met = ours <= limit
        return wanted, "" if met is None else "PASS" if met else "FAIL"
    return "", ""


def readable(seconds: float | None) -> str:
    """A time with a fitting unit."""
    if seconds is None:
        return "–"
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-6:.3g} µs"


def table(engines: list[Engine], medians: Medians) -> str:
    """The figures as a Markdown table."""
    names = [engine.name for engine in engines]
    ratios = [name for name in names if name != OURS]
    header = ["case", *names, *(f"{name} : {OURS}" for name in ratios), "wanted", ""]
    rows = [header, ["---"] + ["---:"] * (len(header) - 2) + ["---"]]
    for case in (*IN_PROCESS, *STARTS, COLD_BUILD):
        times = medians.get(case.key)
        if times is None:
            continue
        ours = times.get(OURS)
        shown = [readable(times.get(name)) for name in names]
        compared = [f"{times[name] / ours:.2f}" if ours and name in times else "–" for name in ratios]
        rows.append([case.title, *shown, *compared, *verdict(case, times)])
    widths = [max(len(row[column]) for row in rows) for column in range(len(header))]
    return "\n".join(
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |"
        for row in rows
    )


def put_between_marks(page: Path, figures: str, marks: tuple[str, str] = MARKS) -> None:
    """Replace what stands between the two marks of a page."""
    before, opening, rest = page.read_text(encoding="utf-8").partition(marks[0])
    _, closing, after = rest.partition(marks[1])
    if not opening or not closing:
        raise SystemExit(f"{page} has no {marks[0]} ... {marks[1]}")
    page.write_text(f"{before}{opening}\n\n{figures}\n\n{closing}{after}", encoding="utf-8")


def main() -> None:
    """Measure and print."""
    known = [case.key for case in (*IN_PROCESS, *STARTS, COLD_BUILD)]
    parser = argparse.ArgumentParser(description="Time Carom against PyBullet.")
    parser.add_argument("--oracle", type=Path, default=ROOT / ".oracle" / "bin" / "python")
    parser.add_argument("--mujoco", type=Path, default=ROOT / ".mujoco" / "bin" / "python")
    parser.add_argument("--repetitions", type=int, default=5, help="turns each engine takes")
    parser.add_argument("--seconds", type=float, default=0.2, help="time spent on each case in each turn")
    parser.add_argument("--only", nargs="+", default=known, choices=known, metavar="CASE")
    parser.add_argument("--without-cold-build", action="store_true", help="skip the minute of building")
    parser.add_argument("--json", type=Path, help="write the medians there as well")
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    arguments = parser.parse_args()

    engines = [Engine(OURS, Path(sys.executable), "pybullet_cases", {"PYTHONPATH": str(ROOT / "src")})]
    data = ""
    if arguments.oracle.exists():
        engines.append(Engine(REFERENCE, arguments.oracle.absolute(), "pybullet_cases"))
        data = original_data_directory(arguments.oracle.absolute())
    else:
        print(f"no PyBullet at {arguments.oracle} (make oracle): figures of Carom alone", file=sys.stderr)
    if arguments.mujoco.exists():
        engines.append(Engine("MuJoCo", arguments.mujoco.absolute(), "mujoco_cases", runs_scripts=False))
    cases = [key for key in arguments.only if data or key != "load_original_panda"]

    for case in STARTS:
        engines[0].time_start(case.key)
    medians = measure(engines, cases, arguments.repetitions, arguments.seconds, data)
    if COLD_BUILD.key in cases and not arguments.without_cold_build:
        print("building all kernels in an empty cache", file=sys.stderr, flush=True)
        medians[COLD_BUILD.key] = {OURS: engines[0].time_cold_build()}
    figures = table(engines, medians)
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures)
    if arguments.json:
        arguments.json.parent.mkdir(parents=True, exist_ok=True)
        machine = {
            "machine": platform.machine(),
            "system": platform.system(),
            "python": platform.python_version(),
        }
        arguments.json.write_text(json.dumps({"machine": machine, "seconds": medians}, indent=2) + "\n")


if __name__ == "__main__":
    main()
