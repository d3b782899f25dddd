"""A library that another process has loaded gives the bits that it gives here."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from importlib import util
from pathlib import Path

import pytest
from tests.native.test_same_bits import DIGESTS

from carom.native.targets import this_target

ROOT = Path(__file__).parents[2]


@pytest.mark.long
@pytest.mark.skipif(util.find_spec("ziglang") is None, reason="what compiles the other process is not here")
@pytest.mark.skipif(sys.platform == "win32", reason="needs pipes of POSIX")
def test_calls_made_elsewhere_give_the_same_bits():
    target = this_target()
    where = ["--target", target.name, "--level", next(iter(target.levels)), "--with", ""]
    command = [sys.executable, "-m", "tools.wheels.elsewhere.run", *where]
    runs = ("tied", "questions", "images")
    done = subprocess.run(
        [*command, "tests.native.long_runs", *runs], cwd=ROOT, check=True, capture_output=True, text=True
    )
    assert json.loads(done.stdout) == {name: DIGESTS[name] for name in runs}
    # It would give the same bits if nothing had been done elsewhere, too.
    (calls,) = re.findall(r"(\d+) calls", done.stderr)
    assert int(calls) > 500
