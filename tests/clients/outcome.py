"""What came of a run, and whether two runs came to the same."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

EARLY = 20
"""Up to so many steps two simulations of the same must not drift apart; later, chance may magnify digits."""
DRIFT = 1e-3
"""Largest difference of a position [m] or an angle [rad] up to there."""
SETTLED = 5e-3
"""Or the largest difference over all of the run: worlds that settle to the same may take other ways there."""
NOT_BUILT = "is not available in this version of Carom"

State = list[list[float]]


@dataclass(frozen=True)
class Run:
    """How a watched script ended; see `watch.py`."""

    end: str
    error: str = ""
    steps: int = 0
    states: list[tuple[int, State]] = field(default_factory=list)

    @classmethod
    def read(cls, record: Path, folders: Sequence[Path] = ()) -> Run:
        """The record of a run; one that left none has crashed. Errors name files without these `folders`."""
        if not record.exists():
            return cls("crash")
        found = json.loads(record.read_text())
        states = [(step, state) for step, state in found["states"]]
        error = found["error"]
        for folder in folders:
            error = error.replace(f"{folder}/", "")
        return cls(found["end"], error, found["steps"], states)


@dataclass(frozen=True)
class Verdict:
    """Whether Carom did as PyBullet does, and what is to be said of it."""

    good: bool
    text: str


def compare_runs(real: Run, ours: Run) -> Verdict:
    """Whether a script came to the same: the same end or error, and the same motion at first or all along."""
    if real.end == "crash":
        return Verdict(True, f"PyBullet crashes; here: {ours.end} {ours.error}")
    if real.error:
        same = ours.error.startswith(real.error)
        return Verdict(
            same or not ours.error or NOT_BUILT in ours.error,
            f"PyBullet: {real.error}; here: {ours.error or ours.end}",
        )
    if ours.error or ours.end == "crash":
        return Verdict(NOT_BUILT in ours.error, f"here: {ours.error or ours.end}")
    early, later = drift(real.states, ours.states)
    text = f"{ours.end}, {ours.steps} steps, {early:.1e} apart at first, {later:.1e} at most"
    if ours.steps < min(real.steps, EARLY):
        return Verdict(False, f"{text}; PyBullet: {real.end}, {real.steps} steps")
    return Verdict(early <= DRIFT or later <= SETTLED, text)


def drift(real: list[tuple[int, State]], ours: list[tuple[int, State]]) -> tuple[float, float]:
    """Largest differences of the same steps' states: up to step `EARLY`, and in all."""
    recorded = dict(ours)
    early = later = 0.0
    for step, state in real:
        other = recorded.get(step)
        if other is None:
            continue
        if [len(row) for row in state] != [len(row) for row in other]:
            return float("inf"), float("inf")
        apart = max(
            (abs(a - b) for rows in zip(state, other, strict=True) for a, b in zip(*rows, strict=True)),
            default=0.0,
        )
        later = max(later, apart)
        if step <= EARLY:
            early = later
    return early, later


def compare_trials(real: list[tuple[bool, float]], ours: list[tuple[bool, float]]) -> Verdict:
    """Whether a policy succeeds here about as often as with PyBullet: one trial less may be chance."""
    there, here = (sum(success for success, _ in trials) for trials in (real, ours))
    same = sum(a[0] == b[0] for a, b in zip(real, ours, strict=False))
    returns = [sum(total for _, total in trials) for trials in (real, ours)]
    text = f"{there} of {len(real)} trials succeed with PyBullet, {here} here, {same} end alike"
    return Verdict(
        len(real) == len(ours) > 0 and here >= there - 1,
        f"{text}; rewards {returns[0]:.0f} and {returns[1]:.0f}",
    )


def read_trials(output: Path) -> list[tuple[bool, float]]:
    """What `tasks.py` has printed."""
    lines = output.read_text(encoding="utf-8", errors="replace").splitlines()
    return [tuple(json.loads(line[6:])) for line in lines if line.startswith("trial ")]


def read_tests(report: Path) -> dict[str, str]:
    """The outcome of each test of a JUnit report: passed, failed or skipped."""
    if not report.exists():
        return {}
    outcomes = {}
    for case in ElementTree.parse(report).iter("testcase"):
        failed = case.find("failure") is not None or case.find("error") is not None
        skipped = case.find("skipped") is not None
        name = f"{case.get('classname')}::{case.get('name')}"
        outcomes[name] = "failed" if failed else "skipped" if skipped else "passed"
    return outcomes


def compare_tests(real: dict[str, str], ours: dict[str, str]) -> Verdict:
    """Whether every test that passes with PyBullet passes here."""
    passing = [name for name, outcome in real.items() if outcome == "passed"]
    lost = [name for name in passing if ours.get(name) != "passed"]
    gained = sum(outcome == "passed" and real.get(name) != "passed" for name, outcome in ours.items())
    text = f"{len(passing)} of {len(real)} pass with PyBullet; here {len(passing) - len(lost)} of these"
    text += f" and {gained} more" if gained else ""
    return Verdict(bool(real) and not lost, text + "".join(f"\n    lost: {name}" for name in lost))
