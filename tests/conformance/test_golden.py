"""Carom moves as real PyBullet did: every scenario against the figures recorded from it."""

from __future__ import annotations

import importlib

import pytest

from . import golden
from .catalogue import all_scenarios
from .compare import compare

SCENARIOS = all_scenarios()


def test_every_scenario_has_a_golden_and_every_golden_a_scenario() -> None:
    assert golden.names() == sorted(SCENARIOS), "run `make record`"


def test_goldens_come_from_one_version_of_pybullet() -> None:
    engines = {golden.read(golden.path_of(name)).engine for name in golden.names()}
    assert len(engines) == 1
    assert engines.pop().startswith("pybullet ")


@pytest.mark.parametrize("name", SCENARIOS)
def test_agrees_with_pybullet(name: str) -> None:
    scenario = SCENARIOS[name]
    expected = golden.read(golden.path_of(name)).series
    measured = scenario.series(importlib.import_module("pybullet"))
    agreements = compare(scenario, expected, measured)
    failures = [str(agreement) for agreement in agreements if not agreement.holds]
    shown = "\n  ".join(failures[:12])
    assert not failures, f"{len(failures)} of {len(agreements)} series differ:\n  {shown}"
