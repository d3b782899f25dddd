import io
import os
import sys
import time
from pathlib import Path

import pytest

from carom.native.building.jobs import Job, run_all
from carom.native.building.progress import ProgressLine
from carom.native.building.zig import BuildError, find_zig
from carom.native.targets import NoTarget, this_target

pytest.importorskip("ziglang", reason="kernels are compiled by Zig")


def _job(code: str, done: list[str]) -> Job:
    return Job("this", [sys.executable, "-c", code], lambda: done.append(code))


def test_all_are_run():
    done: list[str] = []
    counts: set[tuple[int, int]] = set()
    run_all([_job(f"x = {i}", done) for i in range(5)], os.environ, lambda *count: counts.add(count))
    assert sorted(done) == [f"x = {i}" for i in range(5)]
    assert (5, 5) in counts


def test_a_failure_says_what_the_program_said():
    with pytest.raises(BuildError, match=r"this could not be built:[\s\S]*no such luck"):
        run_all([_job("raise SystemExit('no such luck')", [])], os.environ, lambda *_: None)


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_an_interrupt_ends_programs_and_what_they_started(tmp_path: Path):
    pids = tmp_path / "pids"
    code = (
        "import subprocess, sys, os; from pathlib import Path; "
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)']); "
        f"Path({str(tmp_path / 'new')!r}).write_text(f'{{os.getpid()}} {{child.pid}}'); "
        f"os.rename({str(tmp_path / 'new')!r}, {str(pids)!r}); child.wait()"
    )

    def interrupt(*_: int) -> None:
        if pids.exists():
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_all([_job(code, [])], os.environ, interrupt)
    program, child = map(int, pids.read_text().split())
    with pytest.raises(ProcessLookupError):
        os.kill(program, 0)
    while Path(f"/proc/{child}").exists() and "Z" not in Path(f"/proc/{child}/stat").read_text().split()[2]:
        time.sleep(0.01)


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_the_line_moves_on_a_terminal_and_is_written_now_and_then_elsewhere():
    terminal, log = _Terminal(), io.StringIO()
    for stream in (terminal, log):
        line = ProgressLine(stream)
        for i in range(3):
            line.show(f"compiling kernels {i}/3", now=i > 0)
        line.end()
    assert terminal.getvalue() == "\rcarom: compiling kernels 1/3, 0 s\rcarom: compiling kernels 2/3, 0 s\n"
    assert log.getvalue() == "carom: compiling kernels 1/3, 0 s\ncarom: compiling kernels 2/3, 0 s\n"


def test_an_unknown_platform_is_named(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("platform.machine", lambda: "riscv64")
    with pytest.raises(NoTarget, match=r"built for x86_64-linux, .*; this is .* on riscv64"):
        this_target()


def test_without_zig_it_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(BuildError, match=r"not installed here: run .* -m pip install"):
        find_zig(tmp_path)
