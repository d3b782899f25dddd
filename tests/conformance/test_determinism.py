"""The same calls give the same bits: twice in one process, and in another process."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

from . import golden
from .catalogue import select
from .scenario import Series

NAMES = [
    "three_robots",
    "robot_removed_midway",
    "floating_tree_tumbles",
    "limits_hit_at_speed",
    "three_boxes_stacked",
]
ROOT = Path(__file__).resolve().parents[2]


def _bits(series: Series) -> dict[str, bytes]:
    return {name: values.tobytes() for name, values in series.items()}


@pytest.mark.parametrize("name", NAMES)
def test_two_runs_in_one_process_are_bit_identical(name: str) -> None:
    pybullet = importlib.import_module("pybullet")
    (scenario,) = select([name])
    assert _bits(scenario.series(pybullet)) == _bits(scenario.series(pybullet))


def test_another_process_gives_the_same_bits(tmp_path: Path) -> None:
    pybullet = importlib.import_module("pybullet")
    command = [sys.executable, "-m", "tests.conformance.record", "--into", str(tmp_path), "--only", *NAMES]
    environment = os.environ | {"PYTHONHASHSEED": "12345"}
    subprocess.run(command, check=True, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL)
    for scenario in select(NAMES):
        elsewhere = golden.read(tmp_path / f"{scenario.name}.npz").series
        assert _bits(scenario.series(pybullet)) == _bits(elsewhere)
