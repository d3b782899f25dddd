"""A handler of a signal may wait for a thread that makes calls: it comes before or after each of ours."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
# The programs end by themselves before, if a handler waits for ever.
PATIENCE = 400


@pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
@pytest.mark.parametrize("interface", ["pybullet", "World", "Worlds"])
def test_no_handler_waits_in_vain_for_a_thread_that_makes_calls(interface: str) -> None:
    command = [sys.executable, "-m", "tests.interrupts.joined.joins", interface]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert not done.returncode, done.stderr[-3000:]
    assert done.stdout.splitlines() == ["all have been called"]
