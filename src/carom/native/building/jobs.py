"""Running programs in parallel; an interrupt ends all of them at once."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import IO

from carom.native.building.zig import BuildError
from carom.native.cpu import core_count

_POLL_SECONDS = 0.05
# Maximum length of a compiler's output in messages: the first errors matter, hundreds may follow from them.
_MAX_CHARACTERS = 3000


@dataclass(frozen=True)
class Job:
    """A program to run.

    Attributes:
        name: Its name in messages.
        command: The program and its arguments.
        done: Called when it has succeeded.
    """

    name: str
    command: Sequence[str]
    done: Callable[[], None]


def run_all(
    jobs: Sequence[Job], environment: Mapping[str, str], progress: Callable[[int, int], None]
) -> None:
    """Run programs, as many at a time as there are cores, started in this order.

    `progress` is called repeatedly with the number of finished jobs and the number of all jobs.

    Raises:
        BuildError: A job failed; the others are stopped. The message has its output.
    """
    waiting = list(reversed(jobs))
    running: list[tuple[Job, subprocess.Popen[bytes], IO[bytes]]] = []
    ended = 0
    try:
        while waiting or running:
            while waiting and len(running) < core_count():
                running.append(_start(waiting.pop(), environment))
            for entry in running:
                job, process, output = entry
                if process.poll() is None:
                    continue
                running.remove(entry)
                with output:
                    if process.returncode != 0:
                        output.seek(0)
                        said = output.read().decode(errors="replace").strip()
                        raise BuildError(f"{job.name} could not be built:\n{said[:_MAX_CHARACTERS]}")
                job.done()
                ended += 1
                break
            else:
                time.sleep(_POLL_SECONDS)
            progress(ended, len(jobs))
    finally:
        for _, process, output in running:
            _end(process)
            output.close()


def _start(job: Job, environment: Mapping[str, str]) -> tuple[Job, subprocess.Popen[bytes], IO[bytes]]:
    output = tempfile.TemporaryFile()  # noqa: SIM115 - closed when the program has ended
    process = subprocess.Popen(
        job.command,
        env=dict(environment),
        stdin=subprocess.DEVNULL,
        stdout=output,
        stderr=subprocess.STDOUT,
        # Compilers start processes of their own; as a process group all of them can be ended.
        start_new_session=os.name == "posix",
    )
    return job, process, output


def _end(process: subprocess.Popen[bytes]) -> None:
    with contextlib.suppress(OSError):
        if os.name == "posix":
            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
    process.wait()
