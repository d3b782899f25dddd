"""Carom's loading of the test scenes against the recorded answers of PyBullet."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from scene_cases import CASES, REFUSED_SDF, SceneCase, ask
from tests.differences import differences
from tests.each import each

import pybullet as p

ANSWERS = json.loads((Path(__file__).parent / "answers" / "scenes_oracle.json").read_text(encoding="utf-8"))


@pytest.fixture
def client():
    client = p.connect(p.DIRECT)
    yield client
    p.disconnect(client)


def is_close(ours: float, theirs: float, where: str) -> bool:
    # What getLinkState says has been through single precision.
    tolerance = 1e-6 if ".links" in where else 1e-9
    return math.isclose(ours, theirs, rel_tol=tolerance, abs_tol=tolerance)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_bodies_are_those_of_pybullet(case: SceneCase, client: int) -> None:
    found = differences(ask(p, case, client), ANSWERS["cases"][case.name], is_close=is_close)
    assert "\n".join(found) == ""


def test_every_case_is_recorded() -> None:
    assert set(ANSWERS["cases"]) == {case.name for case in CASES}
    assert set(ANSWERS["refused sdf"]) == set(REFUSED_SDF)


@each("name", REFUSED_SDF)
def test_sdf_that_pybullet_refuses_is_refused(name: str, tmp_path: Path, client: int) -> None:
    assert ANSWERS["refused sdf"][name]
    file = tmp_path / "broken.sdf"
    file.write_text(REFUSED_SDF[name], encoding="utf-8")
    with pytest.raises(p.error, match="Cannot load SDF file") as raised:
        p.loadSDF(str(file), physicsClientId=client)
    assert str(file) in str(raised.value)
    assert p.getNumBodies(physicsClientId=client) == 0
