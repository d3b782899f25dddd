"""The helpers give the numbers that PyBullet's give."""

from __future__ import annotations

import json

import pytest
from tests.script_helpers import scenes

RECORDED = json.loads(scenes.RECORD.read_text())
# PyBullet computes inertias of shapes, and turns between quaternions, with single precision.
RELATIVE = 1e-5


@pytest.fixture(scope="module")
def found() -> dict[str, list[float]]:
    return scenes.numbers()


@pytest.mark.parametrize("name", RECORDED)
def test_numbers_are_those_of_pybullet(name: str, found: dict[str, list[float]]) -> None:
    assert found[name] == pytest.approx(RECORDED[name], rel=RELATIVE, abs=1e-4)
