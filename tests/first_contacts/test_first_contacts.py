"""First contacts come in the same step and at the same gap as in PyBullet."""

from __future__ import annotations

import json

import pytest
from tests.first_contacts.cases import Case, cases
from tests.first_contacts.compare import outcome
from tests.first_contacts.record import RECORDED

RECORD = json.loads(RECORDED.read_text(encoding="utf-8"))
CASES = list(cases())
# The ones that do not, by name; `docs/conformance/first-contacts.md` has the figures.
ELSEWHERE = {
    "sphere on mesh, base, fall tilted, 0.1": "two triangles are found one after the other there",
    "hull on heightfield, base, fall tilted, 0.1": "another of the triangles comes first",
}


def test_every_case_is_recorded() -> None:
    assert set(RECORD) == {case.name for case in CASES}
    assert set(RECORD) >= set(ELSEWHERE)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_first_contact(case: Case) -> None:
    found = outcome(case, RECORD[case.name])
    if case.name in ELSEWHERE:
        assert not found.same_step
        assert abs(found.steps) <= 1
    else:
        assert found.same_step, found
    # Wherever it is found first, it is on the same side.
    assert found.normals < 0.3
