"""A short run of the workers, in a process without the threads of other tests."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from tests.workers.episodes import METHODS

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("method", METHODS)
def test_workers_see_the_same_bits_as_one_alone(method: str) -> None:
    pytest.importorskip("gymnasium")
    command = [sys.executable, "-m", "tests.workers.episodes", "--workers", "4", "--episodes", "60"]
    done = subprocess.run(
        [*command, "--methods", method], cwd=ROOT, capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr[-2000:]
