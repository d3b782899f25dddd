"""Scripts that run beside the tests."""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def started(*command: str | Path) -> tuple[subprocess.Popen[str], str]:
    """A script that shows its world, and the address it prints."""
    environment = {**os.environ, "CI": "1", "PYTHONUNBUFFERED": "1", "PYTHONPATH": str(ROOT / "src")}
    script = subprocess.Popen(
        [sys.executable, *command],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert script.stdout is not None
    for line in script.stdout:
        if address := re.search(r"http://\S+", line):
            return script, address[0]
    raise AssertionError("no address")
