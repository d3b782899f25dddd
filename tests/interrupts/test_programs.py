"""Calls are atomic: programs in which signals, threads, finalizers, tracers and forks meet them end well."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from tests.interrupts.programs import PROGRAMS
from tests.rings import few

ROOT = Path(__file__).parents[2]
# The longest program takes some seconds; one that hangs ends by itself.
PATIENCE = 120

needs_posix = pytest.mark.skipif(os.name != "posix", reason="needs signals and forks of POSIX")


@needs_posix
@pytest.mark.parametrize("name", few(PROGRAMS, 5))
def test_a_program_ends_well(name: str) -> None:
    assert _run("programs", name) == "well\n"


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 3])
def test_a_storm_ends_well(seed: int) -> None:
    assert _run("storm", "--seconds", "5", "--seed", str(seed)).endswith("well\n")


def _run(module: str, *arguments: str) -> str:
    command = [sys.executable, "-m", f"tests.interrupts.{module}", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE, check=False)
    assert not done.returncode, done.stderr[-3000:]
    return done.stdout
