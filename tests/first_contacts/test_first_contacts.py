"""First contacts are PyBullet's: the step, the gap, the normal, the points and the force."""

from __future__ import annotations

from itertools import product

import pytest
from tests.first_contacts.cases import CONTACTS, MOVING, RESTING, SURFACES, cases
from tests.first_contacts.compare import outcomes
from tests.first_contacts.record import recorded
from tests.rings import few

# Of the motions of two kinds of shape, so many may differ in anything at the first, second and third contact;
# `docs/conformance/first-contacts.md` has the figures. Flat cylinders that land fast touch with another point
# of the face first, and PyBullet keeps old points beside balls.
ELSEWHERE = {
    ("box", "cylinder"): (4, 6, 4),
    ("cylinder", "box"): (6, 6, 6),
    ("cylinder", "cylinder"): (6, 5, 7),
    ("box", "sphere"): (0, 10, 13),
    ("cylinder", "sphere"): (0, 12, 14),
    ("hull", "sphere"): (0, 2, 1),
    ("sphere", "hull"): (0, 1, 1),
}
# On triangles PyBullet's points are others: gaps and forces of so many first contacts may differ.
ON_TRIANGLES = {
    ("sphere", "mesh"): (12, 12),
    ("box", "mesh"): (2, 12),
    ("box", "heightfield"): (7, 14),
}


def test_every_case_is_recorded() -> None:
    assert list(recorded()) == [case.name for case in cases()]


@pytest.mark.parametrize(("moving", "resting"), few(product(MOVING, RESTING), 3))
def test_first_contacts(moving: str, resting: str) -> None:
    found = outcomes([moving], [resting])
    assert len(found) == 64
    for case, contacts in found:
        assert all(it.steps == 0 for it in contacts), case.name
    firsts = [contacts[0] for _, contacts in found]
    if resting in SURFACES:
        gaps, forces = ON_TRIANGLES.get((moving, resting), (7, 7))
        assert sum(not it.same_gap for it in firsts) <= gaps
        assert sum(not it.same_force for it in firsts) <= forces
        return
    for case, contacts in found:
        assert contacts[0].same_gap, case.name
    for place, most in zip(range(CONTACTS), ELSEWHERE.get((moving, resting), (0, 0, 0)), strict=True):
        differing = [case.name for case, them in found if len(them) > place and not them[place].same]
        assert len(differing) <= most, differing
