"""Commands that show, record and serve: what they say and set up, without a page or a server."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.test_cli import ROBOT

from carom.cli import progress
from carom.cli.command_line import _parser, main
from carom.cli.pybullet_files import _named


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    # No browser is opened.
    monkeypatch.setenv("CI", "true")
    (tmp_path / "crane.urdf").write_text(ROBOT.replace('xyz="0 0 3"', 'xyz="0 0 -3"'))
    return tmp_path / "crane.urdf"


@pytest.mark.parametrize("tunnel", ["ssh -L 1:localhost:1 host", None])
def test_who_works_over_ssh_is_told_how_to_see_it(
    tunnel: str | None, robot: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def end() -> None:
        raise KeyboardInterrupt

    viewer = SimpleNamespace(address="http://here", open_browser=lambda: None)
    shown = SimpleNamespace(viewer=viewer, run=end, close=lambda: None)
    monkeypatch.setattr("carom.simulator.simulator.Simulator", lambda *_: shown)
    monkeypatch.setattr("carom.viewer.display.tunnel_command", lambda _: tunnel)
    main(["view", str(robot)])
    said = capsys.readouterr().out
    assert "crane.urdf is shown at http://here\n" in said
    assert ("Over SSH" in said) == (tunnel is not None)
    assert tunnel is None or f"run '{tunnel}'" in said


def test_what_the_command_line_of_view_states(robot: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []

    def note(*arguments: Any) -> None:
        asked.append(arguments)
        raise OSError("enough")

    monkeypatch.setattr("carom.simulator.simulator.Simulator", note)
    words = "--gravity -1.62 --time-step 0.001 --contact rigid --fixed-base --xacro-arg a=b --play --port 0"
    assert main(["view", str(robot), str(robot), *words.split()]) == 1
    ((files, start),) = asked
    assert files == [robot, robot]
    assert start.settings == {"gravity": (0.0, 0.0, -1.62), "time_step": 0.001, "contact": "rigid"}
    assert (start.choices.fixed_base, start.choices.xacro_args) == (True, {"a": "b"})
    assert (start.play, start.port) == (True, 0)
    assert main(["view", str(robot), "--gravity", "1", "2"]) == 1
    assert main(["view", str(robot), "--gravity", "1", "2", "3"]) == 1
    assert asked[1][1].settings == {"gravity": (1.0, 2.0, 3.0)}
    assert main(["view", str(robot.with_name("missing.urdf"))]) == 1


def test_a_server_gets_only_the_options_that_are_stated(monkeypatch: pytest.MonkeyPatch) -> None:
    served: list[Any] = []
    monkeypatch.setattr("carom.cli.serve.serve", served.append)
    main(["serve"])
    main(["serve", "--tcp", "1234"])
    without, stated = (service.options for service in served)
    assert len(without) == 1
    assert stated == [*without, '--tcp="1234"']


def test_of_several_worlds_the_longest_time_is_reported() -> None:
    stream = StringIO()
    line = progress.Progress(stream, 9.0)
    for elapsed in (2.0, 1.0):
        line._due = 0.0
        line.show(elapsed)
    assert stream.getvalue().splitlines() == [
        "Recorded 2.0 of 9 s of simulated time; Ctrl-C ends it",
        "Recorded 2.0 of 9 s of simulated time; Ctrl-C ends it",
    ]


def test_a_recorded_script_opens_no_browser(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CI", "")
    monkeypatch.delenv("CI")
    (tmp_path / "script.py").write_text(
        "import os, pathlib, carom\nworld = carom.World()\nworld.step()\n"
        "pathlib.Path(__file__).with_name('said').write_text(os.environ['CI'])\n"
    )
    main(["record", str(tmp_path / "script.py"), str(tmp_path / "out.html")])
    assert (tmp_path / "said").read_text() == "1"
    assert (tmp_path / "out.html").exists()


def test_the_defaults_of_options_are_those_that_the_help_states() -> None:
    stated, wrong = 0, []
    for parser in _parsers(_parser()):
        for action in parser._actions:
            for words in re.findall(r"\(default ([^,)]+)\)", action.help or ""):
                default = action.const if action.nargs == "?" else action.default
                stated += 1
                shown = f"{default:g}" if isinstance(default, float) else str(default)
                if default is not None and words.split()[-1] != shown:
                    wrong.append((parser.prog, action.dest, words, default))
    assert not wrong
    assert stated >= 6


def test_examples_are_listed_and_copied_beside_what_is_there(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["examples"])
    name = capsys.readouterr().out.splitlines()[0].split()[0]
    main(["examples", name, "--copy", str(tmp_path)])
    copied = [Path(line) for line in capsys.readouterr().out.splitlines()]
    assert tmp_path / f"{name}.py" in copied and all(file.is_file() for file in copied)
    # Another time it would replace what may have been changed.
    assert main(["examples", name, "--copy", str(tmp_path)]) == 1
    assert "is there already" in capsys.readouterr().err


class _Terminal(StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("kind", [StringIO, _Terminal])
def test_a_line_that_is_written_over_is_left_at_the_end(kind: type[StringIO]) -> None:
    stream = kind()
    line = progress.Progress(stream, None)
    line.end()
    assert stream.getvalue() == ""
    line.show(1.0)
    line.end()
    assert stream.getvalue().endswith("it\n") and stream.getvalue().count("\n") == 1


def test_at_most_three_names_are_listed() -> None:
    assert _named(["a", "b", "c"]) == "a, b, c"
    assert _named(["a", "b", "c", "d", "e"]) == "a, b, c and 2 more"


def test_ports_that_are_not_stated_are_those_of_pybullet() -> None:
    plain, with_ports = (_parser().parse_args(["serve", *more]) for more in ([], ["--tcp", "--udp"]))
    assert (plain.key, plain.tcp, plain.udp) == (12347, None, None)
    assert (with_ports.tcp, with_ports.udp) == (6667, 1234)


def _parsers(parser: argparse.ArgumentParser) -> Iterator[argparse.ArgumentParser]:
    """A parser and those of its commands."""
    yield parser
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            for each in action.choices.values():
                yield from _parsers(each)
