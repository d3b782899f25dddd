"""Carom's loading of the test scenes against the recorded answers of PyBullet."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest
from scene_cases import CASES, REFUSED_SDF, SceneCase, ask

import pybullet as p

ANSWERS = json.loads(Path(__file__).with_name("scenes_oracle.json").read_text(encoding="utf-8"))


@pytest.fixture
def client():
    client = p.connect(p.DIRECT)
    yield client
    p.disconnect(client)


def differences(ours: Any, theirs: Any, at: str = "") -> list[str]:
    """Where two nested answers differ by more than rounding."""
    if isinstance(theirs, dict):
        return [text for key in theirs for text in differences(ours[key], theirs[key], f"{at}.{key}")]
    if isinstance(theirs, list):
        if len(ours) != len(theirs):
            return [f"{at}: {len(ours)} instead of {len(theirs)} entries"]
        pairs = zip(ours, theirs, strict=True)
        return [text for index, (a, b) in enumerate(pairs) for text in differences(a, b, f"{at}[{index}]")]
    if isinstance(theirs, float) or isinstance(ours, float):
        # What getLinkState says has been through single precision.
        tolerance = 1e-6 if ".links" in at else 1e-9
        same = math.isclose(ours, theirs, rel_tol=tolerance, abs_tol=tolerance)
    else:
        same = ours == theirs
    return [] if same else [f"{at}: {ours!r} instead of {theirs!r}"]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_bodies_are_those_of_pybullet(case: SceneCase, client: int) -> None:
    assert "\n".join(differences(ask(p, case, client), ANSWERS["cases"][case.name])) == ""


def test_every_case_is_recorded() -> None:
    assert set(ANSWERS["cases"]) == {case.name for case in CASES}
    assert set(ANSWERS["refused sdf"]) == set(REFUSED_SDF)


@pytest.mark.parametrize("name", REFUSED_SDF)
def test_sdf_that_pybullet_refuses_is_refused(name: str, tmp_path: Path, client: int) -> None:
    assert ANSWERS["refused sdf"][name]
    file = tmp_path / "broken.sdf"
    file.write_text(REFUSED_SDF[name], encoding="utf-8")
    with pytest.raises(p.error, match="Cannot load SDF file") as raised:
        p.loadSDF(str(file), physicsClientId=client)
    assert str(file) in str(raised.value)
    assert p.getNumBodies(physicsClientId=client) == 0
