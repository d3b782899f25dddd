"""Runs a command with a line that says what goes on, and for how long; Ctrl-C ends it at once.

    python tools/patiently.py "installing" python -m pip install numpy

For the Makefile: pip is silent for half a minute while it installs, and takes seconds to obey Ctrl-C. What
the command prints is shown when it has ended.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time

PERIOD = 0.25
"""Seconds from one line to the next, which takes its place."""


def run(what: str, command: list[str]) -> int:
    """Run the command in a session of its own; returns its status."""
    began, line, asked = time.monotonic(), "", []
    # Noted, and not raised: it may come while the command starts.
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda *_: asked.append(True))
    with tempfile.TemporaryFile() as said:
        # Ctrl-C reaches this process alone, which does not wait for the command to put things in order.
        process = subprocess.Popen(command, stdout=said, stderr=subprocess.STDOUT, start_new_session=True)
        while (status := wait(process)) is None and not asked:
            if sys.stderr.isatty():
                line = f"\rcarom: {what}, {time.monotonic() - began:.0f} s"
                print(line, end="", file=sys.stderr, flush=True)
        if status is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            status = 128 + signal.SIGINT
        if line:
            print(file=sys.stderr)
        said.seek(0)
        sys.stderr.write(said.read().decode(errors="replace"))
    return status


def wait(process: subprocess.Popen[bytes]) -> int | None:
    """The status of the process, or None if it still runs after a moment."""
    try:
        return process.wait(PERIOD)
    except subprocess.TimeoutExpired:
        return None


if __name__ == "__main__":
    sys.exit(run(sys.argv[1], sys.argv[2:]))
