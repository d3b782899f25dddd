"""Shapes and bodies made by scripts, against the recorded answers of PyBullet."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from record_shapes import plain
from shape_cases import CASES, CORNER_CASES, MESHES, REFUSED, call
from tests.differences import differences
from tests.rings import few

import pybullet as p

ANSWERS = json.loads(Path(__file__).with_name("shapes.json").read_text(encoding="utf-8"))

ABSOLUTE = 1e-12
"""Below this, a figure is rounding."""


@pytest.fixture(autouse=True)
def _world() -> None:
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(str(MESHES))


def test_every_case_is_recorded() -> None:
    assert set(ANSWERS["cases"]) == set(CASES)
    assert set(ANSWERS["corners"]) == set(CORNER_CASES)
    assert set(ANSWERS["refused"]) == set(REFUSED)


@pytest.mark.parametrize("name", few(CASES, 25))
def test_answers_are_those_of_pybullet(name: str) -> None:
    assert differences(plain(CASES[name](p)), ANSWERS["cases"][name]) == []


@pytest.mark.parametrize("name", CORNER_CASES)
def test_corners_of_hulls_are_those_of_pybullet(name: str) -> None:
    ours, theirs = np.array(CORNER_CASES[name](p)), np.array(ANSWERS["corners"][name])
    assert ours.shape == theirs.shape
    if not len(ours):
        return
    distances = np.abs(ours[:, None] - theirs[None]).max(axis=2)
    assert distances.min(axis=0).max() <= ABSOLUTE
    assert distances.min(axis=1).max() <= ABSOLUTE


@pytest.mark.parametrize("name", REFUSED)
def test_what_pybullet_refuses_is_refused_with_its_words(name: str) -> None:
    with pytest.raises(p.error) as raised:
        call(p, *REFUSED[name])
    assert ANSWERS["refused"][name] is not None
    assert str(raised.value).startswith(ANSWERS["refused"][name])
    assert str(raised.value) != ANSWERS["refused"][name], "the particulars follow"
