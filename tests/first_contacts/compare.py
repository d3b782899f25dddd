"""Carom's first contacts beside PyBullet's, as tables: `python -m tests.first_contacts.compare`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import dist
from pathlib import Path
from typing import Any

from tests.first_contacts.cases import CONTACTS, MOVING, RESTING, SURFACES, Case, cases, follow
from tests.first_contacts.record import recorded

import pybullet as p

PAGE = Path(__file__).parents[2] / "docs" / "conformance" / "first-contacts.md"
SAME_GAP = 1e-4
"""Least gaps are the same within this [m]; corners of PyBullet's hulls are off by up to 0.03 mm."""
SAME_FORCE = 0.05
"""So are the sums of normal forces within this fraction, and 0.25 N."""
SAME_NORMAL = 0.02
"""So are the mean normals within this."""
SAME_POINT = 1e-3
"""Points are the same if each is as near to one of the other engine's [m]."""


@dataclass(frozen=True)
class Contact:
    """How one of the first three steps with contact compares.

    Attributes:
        steps: By how many steps Carom's comes later.
        gaps: Least distance here and there [m].
        normals: Greatest difference of the mean normals.
        counts: Number of points here and there.
        points: Greatest distance of a point from the nearest of the other engine [m].
        forces: Sum of the normal forces here and there [N].
    """

    steps: int
    gaps: tuple[float, float]
    normals: float
    counts: tuple[int, int]
    points: float
    forces: tuple[float, float]

    @property
    def same_gap(self) -> bool:
        return abs(self.gaps[0] - self.gaps[1]) <= SAME_GAP

    @property
    def same_force(self) -> bool:
        return abs(self.forces[0] - self.forces[1]) <= SAME_FORCE * self.forces[1] + 0.25

    @property
    def same(self) -> bool:
        """It is the same in all of this."""
        return all(is_same(self) for is_same in QUANTITIES.values())


QUANTITIES: dict[str, Callable[[Contact], bool]] = {
    "step": lambda it: it.steps == 0,
    "gap": lambda it: it.same_gap,
    "normal": lambda it: it.normals <= SAME_NORMAL,
    "number of points": lambda it: it.counts[0] == it.counts[1],
    "places of points": lambda it: it.points <= SAME_POINT,
    "force": lambda it: it.same_force,
}
"""What is compared, and whether it is the same."""

Outcome = tuple[Case, list[Contact]]


def outcome(case: Case, theirs: list[dict[str, Any]]) -> list[Contact]:
    """Follows a case and compares its contacts with PyBullet's."""
    return [_compared(*steps) for steps in zip(follow(p, case), theirs, strict=True)]


def outcomes(moving: Sequence[str] = MOVING, resting: Sequence[str] = RESTING) -> list[Outcome]:
    """Those of all cases of these shapes."""
    known = recorded()
    return [
        (case, outcome(case, known[case.name]))
        for case in cases()
        if case.moving in moving and case.resting in resting
    ]


def _compared(ours: dict[str, Any], theirs: dict[str, Any]) -> Contact:
    one, other = ours["points"], theirs["points"]
    return Contact(
        ours["step"] - theirs["step"],
        (min(it[0] for it in one), min(it[0] for it in other)),
        max(abs(_mean(one, axis) - _mean(other, axis)) for axis in (1, 2, 3)),
        (len(one), len(other)),
        max(_furthest(one, other), _furthest(other, one)),
        (sum(it[7] for it in one), sum(it[7] for it in other)),
    )


def _mean(points: list[list[float]], column: int) -> float:
    return sum(point[column] for point in points) / len(points)


def _furthest(points: list[list[float]], others: list[list[float]]) -> float:
    """How far the loneliest point is from the nearest of the others."""
    return max(min(dist(point[4:7], other[4:7]) for other in others) for point in points)


def page(found: list[Outcome]) -> str:
    """The page of the documentation."""
    solid = [it for it in found if it[0].resting not in SURFACES]
    surfaces = [it for it in found if it[0].resting in SURFACES]
    settings = {
        "cases": len(found),
        "gap": f"{SAME_GAP * 1e3:g}",
        "normal": SAME_NORMAL,
        "point": f"{SAME_POINT * 1e3:g}",
        "force": f"{SAME_FORCE:.0%}",
    }
    parts = [
        _INTRODUCTION.format(**settings),
        f"Of {len(solid)} motions on convex shapes and planes, the same are",
        "",
        *_quantities(solid),
        "",
        f"and of {len(surfaces)} on triangle meshes and height fields",
        "",
        *_quantities(surfaces),
        _BY_KINDS,
        *_kinds(found),
        _DIFFERENCES,
        *(_row(it) for it in solid if not it[1][0].same),
    ]
    return "\n".join(parts) + "\n"


def _quantities(found: list[Outcome]) -> list[str]:
    table = [f"| | {' | '.join(QUANTITIES)} | all |", "|---|" + "---:|" * (len(QUANTITIES) + 1)]
    for place in range(CONTACTS):
        contacts = [them[place] for _, them in found if len(them) > place]
        same = [sum(map(is_same, contacts)) for is_same in QUANTITIES.values()]
        cells = [*map(str, same), str(sum(it.same for it in contacts))]
        table.append(f"| {('first', 'second', 'third')[place]} contact | {' | '.join(cells)} |")
    return table


def _kinds(found: list[Outcome]) -> list[str]:
    table = ["| moving | " + " | ".join(RESTING) + " |", "|---|" + "---:|" * len(RESTING)]
    for moving in MOVING:
        cells = []
        for resting in RESTING:
            those = [them for case, them in found if (case.moving, case.resting) == (moving, resting)]
            counts = [
                str(sum(it[place].same for it in those if len(it) > place)) for place in range(CONTACTS)
            ]
            cells.append(f"{', '.join(counts)} of {len(those)}")
        table.append(f"| {moving} | " + " | ".join(cells) + " |")
    return table


def _row(found: Outcome) -> str:
    case, (first, *_) = found
    gap, other_gap = (1e3 * gap for gap in first.gaps)
    cells = (
        case.name,
        f"{first.steps:+d}",
        f"{gap:.2f}, {other_gap:.2f}",
        f"{first.counts[0]}, {first.counts[1]}",
        f"{first.forces[0]:.0f}, {first.forces[1]:.0f}",
    )
    return f"| {' | '.join(cells)} |"


_INTRODUCTION = """# First contacts

<!-- Written by tests/first_contacts/compare.py. -->

What decides how a motion goes on is the first contact. Bodies of every kind of shape come into contact with
every other: in place at the centre of mass, turned there, away from it, as one of two shapes of a link,
beside another link, and on a hinged link, in place or not. They fall straight and tilted, slide and roll,
with the usual `contactBreakingThreshold` and with one of 0.1, onto shapes that are bases, links, or away from
their body's origin. The first three steps with contact of these {cases} motions are compared with those
recorded in PyBullet 3.2.7: the number of the step, the least gap (within {gap} mm), the mean normal (within
{normal}), the number of points, their places (within {point} mm), and the sum of the normal forces (within
{force}).
"""

_BY_KINDS = """
By kinds of shape, the motions whose first, second and third contact are the same in all of this, of those
there are:
"""

_DIFFERENCES = """
## What differs

On meshes and height fields PyBullet makes a point for each triangle it comes across; Carom leaves out what
inner edges would only push sideways. So normals lean in PyBullet where here they are upright, points are
more, and forces are shared out in another way. Where points of two triangles are within the breaking distance
PyBullet keeps the one it comes across last, so gaps differ mostly with a distance of 0.1.
[Differences](../differences/contact.md) has what comes of it.

On other shapes, these first contacts differ:

| case | steps later | gap here, there [mm] | points here, there | force here, there [N] |
|---|---:|---:|---:|---:|"""


def main() -> None:
    PAGE.write_text(page(outcomes()), encoding="utf-8")


if __name__ == "__main__":
    main()
