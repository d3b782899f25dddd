"""Algorithms about joint axes whose length is not 1: as PyBullet in the drop-in, as the engine in `carom`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.algorithms.axis_cases import ARMS, ask

import pybullet
from carom import World
from carom.algorithms import mass_matrix
from carom.description import JointType
from carom.model.body_spec import BodySpec, LinkSpec

ORACLE = json.loads(Path(__file__).with_name("axes_oracle.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", ARMS)
def test_answers_are_those_of_pybullet(name: str):
    answers = ask(pybullet, ARMS[name])
    assert answers.keys() == ORACLE[name].keys()
    for question, expected in ORACLE[name].items():
        np.testing.assert_allclose(answers[question], expected, rtol=0, atol=1e-9, err_msg=question)


@pytest.mark.parametrize("length", [2.0, 0.5])
def test_carom_has_the_axes_of_its_steps(length: float):
    axis = {"joint_axis": (0.0, 0.0, 1.0), "joint_axis_length": length}
    moments = {"mass": 1.0, "inertia": (0.1, 0.2, 0.3)}
    hinge = LinkSpec("arm", parent=-1, joint_type=JointType.REVOLUTE, **axis, **moments)
    body = World().load(BodySpec("arm", LinkSpec("base"), [hinge], fixed_base=True))
    assert mass_matrix(body, [0.0])[0, 0] == pytest.approx(0.3 * length**2)
