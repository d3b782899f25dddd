"""MuJoCo's law where rows turn with bodies: held bodies that spin, and capsules that lie on planes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.converged.test_yielding import error_of_steps
from tests.converged.turning_scenes import SCENES, STEPS

_RECORDED = json.loads(STEPS.read_text())


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_of_turning_rows_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    assert error_of_steps(_RECORDED[name], SCENES[name], tmp_path) < 1e-10
