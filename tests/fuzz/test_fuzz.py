"""A moment of each fuzzer, in processes of their own, whose memory they measure."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from tests.fuzz import readers
from tests.fuzz.files import SEEDS
from tests.rings import few
from tests.thorough.profiles import cases

ROOT = Path(__file__).parents[2]


def run(*arguments: str) -> None:
    command = [sys.executable, "-m", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0, done.stderr[-4000:]


@pytest.mark.parametrize("seed", few(range(3), 2))
def test_random_calls(seed: int) -> None:
    run("tests.fuzz.api", "--operations", str(cases(1000)), "--seed", str(seed))


# Of the drop-in, whose many kinds share a process, and of `carom`.
@pytest.mark.parametrize("kinds", [[kind for kind in SEEDS if kind not in readers.SEEDS], [*readers.SEEDS]])
def test_damaged_files(kinds: Sequence[str]) -> None:
    run("tests.fuzz.files", "--here", "--cases", str(cases(20)), "--kinds", *kinds)


@pytest.mark.long
@pytest.mark.parametrize("kind", [kind for kind in SEEDS if kind not in readers.SEEDS])
def test_more_damaged_files(kind: str) -> None:
    run("tests.fuzz.files", "--here", "--cases", str(cases(60)), "--kinds", kind)
