"""Carom's first contacts beside PyBullet's, as a table: `python -m tests.first_contacts.compare`."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tests.first_contacts.cases import MOVING, RESTING, Case, cases, follow
from tests.first_contacts.record import RECORDED

import pybullet as p

PAGE = Path(__file__).parents[2] / "docs" / "conformance" / "first-contacts.md"
SAME_GAP = 1e-4
"""First gaps are the same within this [m]; corners of PyBullet's hulls are off by up to 0.03 mm."""
SAME_FORCE = 0.05
"""So are the sums of normal forces within this fraction, and 0.25 N."""
SAME_NORMAL = 0.02
"""So are the mean normals within this."""


@dataclass(frozen=True)
class Outcome:
    """How the first contact of a case compares.

    Attributes:
        case: The case.
        steps: By how many steps Carom's comes later.
        gaps: Least distance here and there [m].
        forces: Sum of the normal forces here and there [N].
        counts: Number of points here and there.
        normals: Greatest difference of the mean normals.
    """

    case: Case
    steps: int
    gaps: tuple[float, float]
    forces: tuple[float, float]
    counts: tuple[int, int]
    normals: float

    @property
    def same_step(self) -> bool:
        """It comes in the same step, at the same gap."""
        return self.steps == 0 and abs(self.gaps[0] - self.gaps[1]) <= SAME_GAP

    @property
    def same(self) -> bool:
        """Its normal and force are the same, too."""
        ours, theirs = self.forces
        close = abs(ours - theirs) <= SAME_FORCE * theirs + 0.25
        return self.same_step and close and self.normals <= SAME_NORMAL


def outcome(case: Case, recorded: list[dict[str, Any]]) -> Outcome:
    """Follows a case and compares its first contact with PyBullet's."""
    ours, theirs = follow(p, case)[0], recorded[0]
    return Outcome(
        case,
        ours["step"] - theirs["step"],
        (_least(ours), _least(theirs)),
        (_force(ours), _force(theirs)),
        (len(ours["points"]), len(theirs["points"])),
        max(abs(a - b) for a, b in zip(_normal(ours), _normal(theirs), strict=True)),
    )


def outcomes() -> list[Outcome]:
    """Those of all cases."""
    recorded = json.loads(RECORDED.read_text(encoding="utf-8"))
    return [outcome(case, recorded[case.name]) for case in cases()]


def _least(step: dict[str, Any]) -> float:
    return min(point[0] for point in step["points"])


def _force(step: dict[str, Any]) -> float:
    return sum(point[5] for point in step["points"])


def _normal(step: dict[str, Any]) -> list[float]:
    points = step["points"]
    return [sum(point[axis] for point in points) / len(points) for axis in (1, 2, 3)]


def page(found: list[Outcome]) -> str:
    """The page of the documentation."""
    counts = {
        "cases": len(found),
        "in_step": sum(it.same_step for it in found),
        "same": sum(it.same for it in found),
        "gap": f"{SAME_GAP * 1e3:g}",
        "normal": SAME_NORMAL,
        "force": f"{SAME_FORCE:.0%}",
    }
    table = ["| moving | " + " | ".join(RESTING) + " |", "|---|" + "---:|" * len(RESTING)]
    for moving in MOVING:
        rows = [
            [it for it in found if (it.case.moving, it.case.resting) == (moving, resting)]
            for resting in RESTING
        ]
        entries = [f"{sum(it.same for it in row)} of {len(row)}" for row in rows]
        table.append(f"| {moving} | " + " | ".join(entries) + " |")
    rest = [_row(it) for it in found if not it.same]
    return "\n".join([_INTRODUCTION.format(**counts), *table, _DIFFERENCES, *rest]) + "\n"


def _row(it: Outcome) -> str:
    gap, other_gap = (1e3 * gap for gap in it.gaps)
    cells = (
        it.case.name,
        f"{it.steps:+d}",
        f"{gap:.2f}, {other_gap:.2f}",
        f"{it.counts[0]}, {it.counts[1]}",
        f"{it.forces[0]:.0f}, {it.forces[1]:.0f}",
    )
    return f"| {' | '.join(cells)} |"


_INTRODUCTION = """# First contacts

<!-- Written by tests/first_contacts/compare.py. -->

What decides how a motion goes on is the first contact. Bodies of every kind of shape come into contact with
every other: in place at the centre of mass, turned there, away from it, beside another shape, and on a link;
they fall, slide and roll, with the usual and with a larger `contactBreakingThreshold`. The first contacts are
compared with those recorded in PyBullet 3.2.7.

Of {cases} cases {in_step} make their first contact in the same step and at the same gap (within {gap} mm);
in {same} the normal (within {normal}) and the sum of the normal forces (within {force}) are the same, too. In
the table, by kinds of shape: the cases that are the same in all of this, of those there are.
"""

_DIFFERENCES = """
## What differs

On meshes and height fields PyBullet makes a point for each triangle it comes across; Carom leaves out what
inner edges would only push sideways. So normals lean in PyBullet where here they are upright, points are
more, and forces are shared out in another way, while their sum and the gap are the same.
[Differences](../differences.md#contact) has what comes of it. On other shapes nothing differs.

| case | steps later | gap here, there [mm] | points here, there | force here, there [N] |
|---|---:|---:|---:|---:|"""


def main() -> None:
    PAGE.write_text(page(outcomes()), encoding="utf-8")


if __name__ == "__main__":
    main()
