"""MuJoCo's law where rows turn with bodies: held bodies that spin, and capsules that lie on planes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.converged.test_yielding import error_of_steps
from tests.converged.turning_scenes import SCENES, STEPS

from carom import World

_RECORDED = json.loads(STEPS.read_text())


@pytest.mark.parametrize("name", SCENES)
def test_accelerations_of_turning_rows_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    # Angles of welds are not parts of a quaternion, as MuJoCo's are.
    bound = 0.04 if "weld" in name else 1e-10
    assert error_of_steps(_RECORDED[name], SCENES[name], tmp_path) < bound


def test_held_links_that_move_have_no_exact_derivatives(tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(SCENES["connect of two"])
    world = World(contact="compliant")
    world.load(path).apply_options()
    assert np.isfinite(world.linearize(method="exact").A).all()
    world.step(10)
    with pytest.raises(
        NotImplementedError, match=r'constraint 0 holds links that move.*method="differences"'
    ):
        world.linearize(method="exact")
    assert np.isfinite(world.linearize(method="differences").A).all()
