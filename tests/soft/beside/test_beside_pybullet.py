"""Soft bodies sag, rest and swing as in PyBullet where that is stable, and stand where it is not."""

from __future__ import annotations

import pytest
from tests.each import each
from tests.soft.beside.cases import CASES
from tests.soft.beside.compare import outcome, recordings

RECORDED = recordings()


def test_every_case_is_recorded() -> None:
    assert list(RECORDED) == list(CASES), "run `make record`"
    # There is something to compare with, and something to stand.
    assert sum(record["stable"] for record in RECORDED.values()) > 60
    assert sum(record["figure"] is None for record in RECORDED.values()) > 5


@each("name", list(CASES)[::8])
def test_figures(name: str) -> None:
    found = outcome(CASES[name], RECORDED[name])
    assert found.holds, found


@pytest.mark.long
@each("name", CASES)
def test_all_figures(name: str) -> None:
    found = outcome(CASES[name], RECORDED[name])
    assert found.holds, found
