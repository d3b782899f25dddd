"""The engines: an interpreter each, and the module that knows how to drive them."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from worker import ANSWER

ROOT = Path(__file__).resolve().parents[1]
HERE = Path(__file__).resolve().parent


class Worker:
    """A process that times cases of one engine when asked to."""

    def __init__(self, engine: str, process: subprocess.Popen[str]) -> None:
        self._engine = engine
        self._process = process

    def time(self, case: str) -> float | None:
        """Median seconds of a call; None if the engine lacks the case or failed at it, which is said."""
        requests, answers = self._process.stdin, self._process.stdout
        assert requests is not None
        assert answers is not None
        requests.write(case + "\n")
        requests.flush()
        for line in answers:
            if line.startswith(ANSWER):
                answer = json.loads(line.removeprefix(ANSWER))
                if "failure" in answer:
                    print(f"{self._engine}: {case}: {answer['failure']}", file=sys.stderr, flush=True)
                return answer.get("seconds")
        raise RuntimeError(f"{self._engine} ended while it timed {case}")


@dataclass(frozen=True)
class Engine:
    """An engine in an interpreter of its own.

    Attributes:
        name: Its column in the table.
        interpreter: Python that has the engine installed.
        module: Module in this directory that prepares its cases.
        environment: Variables set for its processes.
        runs_scripts: It has PyBullet's interface, so process timings apply.
    """

    name: str
    interpreter: Path
    module: str
    environment: dict[str, str] = field(default_factory=dict)
    runs_scripts: bool = True

    @contextmanager
    def worker(self, seconds: float, original_data: str) -> Iterator[Worker]:
        """A new process that times cases, `seconds` on each, until the context ends."""
        command = [str(self.interpreter), str(HERE / "worker.py"), self.module]
        command += ["--seconds", str(seconds), "--original-data", original_data]
        with subprocess.Popen(
            command,
            env=self._environment(),
            cwd=ROOT,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as process:
            yield Worker(self.name, process)
            process.communicate()

    def time_start(self, thing: str) -> float:
        """Seconds from the start of a process until it has done one of the things in start.py."""
        command = [str(self.interpreter), str(HERE / "start.py"), thing]
        start = time.perf_counter()
        with subprocess.Popen(
            command,
            env=self._environment(),
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as process:
            assert process.stdout is not None
            for line in process.stdout:
                if line == "done\n":
                    finished = time.perf_counter() - start
                    process.stdout.read()
                    return finished
        raise RuntimeError(f"{self.name} did not get to {thing}")

    def time_cold_build(self) -> float:
        """Seconds that building all kernels into an empty cache takes."""
        command = [str(self.interpreter), "-m", "carom", "warmup"]
        with tempfile.TemporaryDirectory() as cache:
            environment = self._environment() | {"CAROM_CACHE_PATH": cache}
            start = time.perf_counter()
            subprocess.run(
                command,
                env=environment,
                cwd=ROOT,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                check=True,
            )
            return time.perf_counter() - start

    def _environment(self) -> dict[str, str]:
        # Users' processes find the bytecode of the modules they import.
        left_out = ("PYTHONPATH", "PYTHONDONTWRITEBYTECODE")
        inherited = {name: value for name, value in os.environ.items() if name not in left_out}
        return inherited | self.environment


def original_data_directory(oracle: Path) -> str:
    """Where the original pybullet_data lies."""
    command = [str(oracle), "-c", "import pybullet_data; print(pybullet_data.getDataPath())"]
    return subprocess.run(command, check=True, cwd=HERE, capture_output=True, text=True).stdout.strip()
