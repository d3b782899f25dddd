"""Faults that are put into a module: each spoils one thing, and nothing else."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.differ.test_programs import call
from tools.differ.faults.run import is_touched
from tools.differ.faults.spoiling import Fault, Spoiled, arguments, of_each, put, result, scaled, times
from tools.differ.faults.table import FAULTS
from tools.differ.pair import environment_of

import pybullet as p


class Module:
    """A module with two functions."""

    def given(self, *given: Any, **keywords: Any) -> Any:
        return given, keywords

    def pairs(self) -> Any:
        return ((1, 2.0), (3, 4.0))


def spoiled(fault: Fault) -> Any:
    module = Module()
    return Spoiled(module, fault.changes(module))


def test_results_are_spoiled():
    module = spoiled(result("", "", "pairs", of_each(1, lambda part: part + 1)))
    assert module.pairs() == ((1, 3.0), (3, 5.0))
    assert module.given(1) == ((1,), {})


def test_arguments_are_spoiled():
    module = spoiled(arguments("", "", "given", scaled("force", by=2.0, place=1)))
    assert module.given(1, [2, 3], force=(4.0,), other=5) == ((1, [4, 6]), {"force": (8.0,), "other": 5})


def test_nothing_but_numbers_is_scaled():
    assert times([1, "a", (2.0, None)], 3) == [3, "a", (6.0, None)]


def test_numbers_of_images_are_scaled():
    assert times([np.float32(0.5), np.uint8(2)], 3) == [1.5, 6]
    assert put((1, 2, 3), 1, 0) == (1, 0, 3)


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_faults_spoil_functions_there_are(fault: Fault):
    changes = fault.changes(p)
    assert fault.functions <= changes.keys()
    assert all(hasattr(p, name) for name in changes)


def test_there_are_faults_of_all_sections():
    assert len(FAULTS) >= 40
    assert len({fault.section for fault in FAULTS.values()}) >= 14


@pytest.mark.parametrize(
    ("function", "expected"), [("getBaseVelocity", True), ("@probe", True), ("stepSimulation", False)]
)
def test_what_a_fault_does_not_spoil_is_not_performed(function: str, expected: bool):
    fault = result("", "", "getBaseVelocity", of_each(0, lambda part: part))
    assert is_touched([call(0, function)], fault) == expected


def test_gravity_is_spoiled_behind_the_back_of_its_getter():
    client = p.connect(p.DIRECT)
    try:
        module: Any = Spoiled(p, FAULTS["gravity 1e-5 on one axis"].changes(p))
        module.setGravity(1, 0, -10)
        assert p.getPhysicsEngineParameters()["gravityAccelerationX"] == 1.00001
        assert module.getPhysicsEngineParameters()["gravityAccelerationX"] == pytest.approx(1.0, abs=1e-12)
    finally:
        p.disconnect(client)


def test_friction_is_spoiled_behind_the_back_of_its_getter():
    client = p.connect(p.DIRECT)
    try:
        module: Any = Spoiled(p, FAULTS["friction + 1 %"].changes(p))
        body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
        module.changeDynamics(body, -1, lateralFriction=0.3)
        with pytest.raises(TypeError):
            module.changeDynamics(body, -1, lateralFriction=0.4, mass="heavy")
        assert p.getDynamicsInfo(body, -1)[1] == pytest.approx(0.303, rel=1e-12)
        assert module.getDynamicsInfo(body, -1)[1] == 0.3
    finally:
        p.disconnect(client)


def test_a_tree_is_named_instead_of_the_path_that_is_set(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    monkeypatch.setenv("PYTHONPATH", "elsewhere")
    assert "PYTHONPATH" not in environment_of(None)
    assert environment_of(tmp_path)["PYTHONPATH"] == str(tmp_path / "src")
