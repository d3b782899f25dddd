"""Carom's reading of the test robots against the recorded answers of PyBullet."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from load_cases import CASES, DATA, REFUSED, LoadCase
from pybullet_view import dynamics_infos, joint_infos
from tests.differences import differences
from tests.each import each

from carom.errors import DescriptionError
from carom.formats.urdf import read_urdf
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble
from carom.model.body_spec import BodySpec

ANSWERS = json.loads((Path(__file__).parent / "answers" / "oracle.json").read_text(encoding="utf-8"))


def load(case: LoadCase) -> BodySpec:
    robot = read_urdf(DATA / case.file, scale=case.scale)
    return assemble(robot, flags=LoadFlags(case.flags), fixed_base=case.fixed_base)


@each("case", CASES, ids=lambda case: case.name)
def test_joints_are_reported_as_by_pybullet(case: LoadCase) -> None:
    body = load(case)
    answer = ANSWERS["cases"][case.name]
    assert [body.base.name, body.name] == answer["names"]
    assert differences(joint_infos(body), answer["joints"]) == []


@each("case", CASES, ids=lambda case: case.name)
def test_dynamics_are_reported_as_by_pybullet(case: LoadCase) -> None:
    body = load(case)
    assert differences(dynamics_infos(body), ANSWERS["cases"][case.name]["dynamics"]) == []


def test_every_case_is_recorded() -> None:
    assert set(ANSWERS["cases"]) == {case.name for case in CASES}
    assert set(ANSWERS["refused"]) == set(REFUSED)


@each("name", REFUSED)
def test_what_pybullet_refuses_is_refused(name: str, tmp_path: Path) -> None:
    assert ANSWERS["refused"][name]
    file = tmp_path / "broken.urdf"
    file.write_text(REFUSED[name], encoding="utf-8")
    with pytest.raises(DescriptionError) as raised:
        read_urdf(file)
    assert raised.value.file == file
    assert str(file) in str(raised.value)
    assert raised.value.reason
    assert raised.value.line is not None or name in ("empty", "no robot")
