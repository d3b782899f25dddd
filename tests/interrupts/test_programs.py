"""Calls are atomic: programs in which signals, threads, finalizers, tracers and forks meet them end well."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.interrupts.programs import PROGRAMS

ROOT = Path(__file__).parents[2]
# The longest program takes some seconds; one that hangs ends by itself.
PATIENCE = 120

needs_posix = pytest.mark.skipif(os.name != "posix", reason="needs signals and forks of POSIX")


@needs_posix
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_ends_well(name: str) -> None:
    command = [sys.executable, "-m", "tests.interrupts.programs", name]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stdout) == (0, "well\n"), done.stderr[-3000:]
