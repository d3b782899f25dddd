"""A moment of each fuzzer, in processes of their own, whose memory they measure."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from tests.fuzz.files import SEEDS
from tests.thorough.profiles import cases

ROOT = Path(__file__).parents[2]


def run(*arguments: str) -> None:
    command = [sys.executable, "-m", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr[-4000:]


@pytest.mark.parametrize("seed", range(3))
def test_random_calls(seed: int) -> None:
    run("tests.fuzz.api", "--operations", str(cases(1000)), "--seed", str(seed))


@pytest.mark.parametrize("kind", SEEDS)
def test_damaged_files(kind: str) -> None:
    run("tests.fuzz.files", "--cases", str(cases(60)), "--kinds", kind)
