"""The same calls give the same bits on every machine and at every CPU level."""

import json
import os
import subprocess
import sys

import pytest
from tests.native.long_runs import digests

from carom.native.cpu import cpu_levels
from carom.native.library import library
from carom.native.targets import this_target

DIGESTS = {
    "arm": "44a72bd4a08b3ca5",
    "stack": "6b56066c09446726",
    "tied": "064ac2b19117a7d3",
    "questions": "841941a168e6a148",
    "images": "431fb34b18d386ca",
    "robots": "89c8654458655c5c",
    "meshes": "43f70b52eb4b245a",
    "soft": "0db4d81ba8ec3d09",
}
"""Of the bits of all numbers in `long_runs`; they change when what the kernels compute does."""


def test_long_runs_give_the_bits_they_have_always_given():
    assert digests() == DIGESTS


@pytest.mark.long  # Builds the library for the other level.
def test_levels_agree(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv("CAROM_CPU_LEVEL", raising=False)
    oldest = next(iter(this_target().levels))
    if oldest not in cpu_levels() or library().path.stem.endswith(oldest):
        pytest.skip("this machine has no other level")
    done = subprocess.run(
        [sys.executable, "-m", "tests.native.long_runs"],
        env={**os.environ, "CAROM_CPU_LEVEL": oldest},
        check=True,
        capture_output=True,
        text=True,
    )
    assert json.loads(done.stdout) == DIGESTS
