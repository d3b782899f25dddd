"""Soft bodies of Carom beside PyBullet's, as a page: `python -m tests.soft.beside.compare`."""

from __future__ import annotations

import importlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.soft.beside.cases import CASES, Case
from tests.soft.beside.measure import perform
from tests.soft.beside.record import RECORDED

PAGE = Path(__file__).parents[3] / "docs" / "conformance" / "soft-bodies.md"
# Greatest difference from PyBullet: as a share of its figure, and as a length [m], whichever allows more.
_TOLERANCES = {
    "cloth_by_an_edge": (0.05, 0.0),
    "cloth_by_two_corners": (0.05, 0.0),
    "cantilever": (0.05, 0.0),
    "cloth_swings": (0.03, 0.0),
    "dropped": (0.02, 0.002),
}


@dataclass(frozen=True)
class Outcome:
    """How a case compares.

    Attributes:
        case: The case.
        ours: Its figure here [m or s]; None if the body exploded.
        theirs: That in PyBullet.
        stable: Whether PyBullet's does not depend on the time step.
        settled: What PyBullet's is with a time step that is short enough; None if none was.
    """

    case: Case
    ours: float | None
    theirs: float | None
    stable: bool
    settled: float | None

    @property
    def wanted(self) -> float | None:
        """The figure that ours has to have, if it is known."""
        return self.theirs if self.stable else self.settled

    @property
    def holds(self) -> bool:
        """Ours has the figure of PyBullet, and stands where PyBullet has none."""
        if self.ours is None or self.wanted is None:
            return self.ours is not None
        share, length = _TOLERANCES[self.case.experiment]
        return abs(self.ours - self.wanted) <= max(share * abs(self.wanted), length)


def outcome(case: Case, recorded: dict[str, Any]) -> Outcome:
    """Does the experiment of a case with Carom, beside what was recorded."""
    result = perform(importlib.import_module("pybullet"), case.experiment, case.options)
    return Outcome(case, result.figure, recorded["figure"], recorded["stable"], recorded["settled"])


def recordings() -> dict[str, dict[str, Any]]:
    """What PyBullet made of each case."""
    return json.loads(RECORDED.read_text(encoding="utf-8"))


def page(found: list[Outcome]) -> str:
    """The page of the documentation."""
    stable = [it for it in found if it.stable]
    others = [it for it in found if not it.stable]
    counts = {
        "cases": len(found),
        "stable": len(stable),
        "agree": sum(it.holds for it in stable),
        "others": len(others),
        "stand": sum(it.holds for it in others),
    }
    first = [_row(it, _number(it.theirs)) for it in stable]
    second = [_row(it, "explodes" if it.theirs is None else _number(it.theirs)) for it in others]
    return (
        "\n".join([_INTRODUCTION.format(**counts), *first, _UNSTABLE.format(**counts), *second, _TASKS])
        + "\n"
    )


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _row(it: Outcome, theirs: str) -> str:
    cells = [it.case.name, _number(it.ours), theirs]
    if not it.stable:
        cells.append(_number(it.settled))
    away = "" if it.ours is None or it.wanted is None else f"{100.0 * (it.ours / it.wanted - 1.0):+.2f} %"
    return f"| {' | '.join([*cells, away])} |"


_INTRODUCTION = """# Soft bodies

<!-- Written by tests/soft/beside/compare.py. -->

Cloth that hangs and swings, beams held at one end, cubes and balls dropped on a floor: around one choice
of parameters for each, stiffness, damping, mass, resolution, margin and time step go their ways. Compared
are how far cloth and beams sag [m], the height of what was dropped at rest [m], and the period of swings
[s]. `rate` is the number of time steps in a second, 240 if it is not named.

PyBullet was asked for the same at four times the rate as well. Where the figures agree it is stable: in
{stable} of {cases} cases. In {agree} of these Carom's sag is within 5 %, its height within 2 mm or 2 %, its
period within 3 %. What is left of a difference is mostly that one of the two has not come to rest entirely.

| case | Carom | PyBullet | difference |
|---|---:|---:|---:|"""

_UNSTABLE = """
## Where PyBullet is not stable

In {others} cases PyBullet's bodies explode, or come to rest somewhere that depends on the time step. Carom
stands in {stand} of them. With short enough time steps PyBullet is stable as well, which tells where the body
should be; the difference is that from there.

| case | Carom | PyBullet | with shorter steps | difference |
|---|---:|---:|---:|---:|"""

# Measured by hand, with dedo's own scripts; the figures are the sum of rewards, and the steps.
_TASKS = """
## The tasks of dedo

Sum of rewards of the preset motions of [dedo](https://github.com/contactrika/dedo), with anchors as the
robot, seed 0 and episodes of 200 steps, and the number of steps until the episode ends, on 27 November
2026. On the right the same with anchors that collide with nothing: as they are, each overlaps the cloth
that it holds, and [contact there](../differences/soft-bodies.md) throws off their speed controller,
which is at the limit of its stability; episodes end early where an anchor leaves the workspace. About
half to nine tenths of the sum is the last reward, from where the cloth is 500 time steps after the
motion has ended; -: not measured.

| task | PyBullet | Carom | PyBullet, no collisions | Carom, no collisions |
|---|---:|---:|---:|---:|
| HangGarment | -22.41 (201) | -25.46 (201) | -27.68 (201) | -25.77 (201) |
| HangBag | -45.84 (201) | -51.55 (201) | -89.88 (201) | -47.33 (201) |
| HangProcCloth | -165.85 (201) | -165.61 (201) | - | - |
| Button | -16.94 (201) | -22.20 (201) | -14.35 (201) | -14.13 (201) |
| ButtonProc | -17.00 (201) | -16.90 (201) | - | - |
| Hoop | -631.10 (133) | -43.43 (201) | -49.73 (201) | -42.34 (201) |
| Lasso | -299.88 (123) | -288.82 (109) | -82.45 (201) | -86.33 (201) |
| Mask | -62.56 (201) | -748.12 (201) | -9.10 (201) | -9.93 (201) |
| DressBag | -132.37 (201) | -131.53 (201) | - | - |
| DressGarment | -137.00 (201) | -125.24 (201) | - | - |"""


def main() -> None:
    recorded = recordings()
    found = [outcome(case, recorded[name]) for name, case in CASES.items()]
    PAGE.write_text(page(found), encoding="utf-8")


if __name__ == "__main__":
    main()
