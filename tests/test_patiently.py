"""`make` says what goes on while pip works, and Ctrl-C ends it: `tools/patiently.py`."""

import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path

import pytest

pytestmark = pytest.mark.skipif(os.name != "posix", reason="make and process groups of POSIX")

TOOL = Path(__file__).parents[1] / "tools" / "patiently.py"
# Says that it runs, and obeys no signal that can be disobeyed.
STUBBORN = """
import os, signal, sys, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
signal.signal(signal.SIGTERM, signal.SIG_IGN)
with open(sys.argv[1], "w") as file:
    file.write(str(os.getpid()))
os.rename(sys.argv[1], sys.argv[1] + ".written")
time.sleep(600)
"""


def patiently(*command: object, **options: object) -> "subprocess.Popen[str]":
    arguments = [sys.executable, str(TOOL), "waiting", *map(str, command)]
    return subprocess.Popen(arguments, text=True, stderr=subprocess.PIPE, **options)  # type: ignore[call-overload]


def test_status_and_output_are_the_commands():
    script = "import sys; print('shown'); print('as well', file=sys.stderr); sys.exit(3)"
    process = patiently(sys.executable, "-c", script)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 3
    assert sorted(said.splitlines()) == ["as well", "shown"]


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_ends_a_command_that_does_not_listen(sent, tmp_path):
    number = tmp_path / "number"
    # A job in the background of a shell, as tests may be, ignores Ctrl-C, and so would what it starts.
    listening = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    process = patiently(sys.executable, "-c", STUBBORN, number, preexec_fn=listening)
    written = tmp_path / "number.written"
    while not written.exists():
        assert process.poll() is None
    os.kill(process.pid, sent)
    process.communicate(timeout=60)
    assert process.returncode == 128 + signal.SIGINT
    with pytest.raises(ProcessLookupError):
        os.kill(int(written.read_text()), 0)


def test_a_terminal_sees_a_line_that_moves():
    import pty

    terminal, end = pty.openpty()
    command = [sys.executable, str(TOOL), "waiting", sys.executable, "-c", "import time; time.sleep(1.0)"]
    subprocess.run(command, stderr=end, check=True, timeout=60)
    os.close(end)
    lines = os.read(terminal, 65536).decode().split("\r")
    os.close(terminal)
    assert "carom: waiting, 0 s" in lines
    assert len([line for line in lines if line.startswith("carom: waiting, ")]) >= 2
