"""Commands that show, record and serve: what they say and set up, without a page or a server."""

from __future__ import annotations

from io import StringIO
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.test_cli import ROBOT

import pybullet_data
from carom.cli import progress
from carom.cli.command_line import main
from carom.cli.show_robot import RobotView
from carom.formats.search import AssetSearch


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    # No browser is opened.
    monkeypatch.setenv("CI", "true")
    (tmp_path / "crane.urdf").write_text(ROBOT.replace('xyz="0 0 3"', 'xyz="0 0 -3"'))
    return tmp_path / "crane.urdf"


def test_a_robot_is_shown_as_a_whole_with_its_joints_at_zero(robot: Path) -> None:
    view = RobotView(robot, AssetSearch(Path(pybullet_data.getDataPath())), "127.0.0.1", 0)
    ((_, joint, slider),) = view._sliders
    assert joint == 0
    assert (slider.name, slider.lower, slider.upper, slider.value) == ("slew", -1.5, 2.5, 0.0)
    orbit = view.viewer.camera.orbit
    view.viewer.close()
    # The links are at (0, 0, 0), (0.5, 0, -3) and (0, 1, -3).
    assert orbit.target == pytest.approx((0.25, 0.5, -1.5))
    assert orbit.distance == pytest.approx(3.3)


@pytest.mark.parametrize("tunnel", ["ssh -L 1:localhost:1 host", None])
def test_who_works_over_ssh_is_told_how_to_see_it(
    tunnel: str | None, robot: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def end() -> None:
        raise KeyboardInterrupt

    shown = SimpleNamespace(viewer=SimpleNamespace(address="http://here", close=lambda: None), run=end)
    monkeypatch.setattr("carom.cli.show_robot.RobotView", lambda *_: shown)
    monkeypatch.setattr("carom.viewer.display.tunnel_command", lambda _: tunnel)
    main(["view", str(robot)])
    said = capsys.readouterr().out
    assert "crane.urdf is shown at http://here\n" in said
    assert ("Over SSH" in said) == (tunnel is not None)
    assert tunnel is None or f"run '{tunnel}'" in said


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


def test_a_shown_robot_follows_its_sliders_sixty_times_a_second(
    robot: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    view = RobotView(robot, AssetSearch(Path(pybullet_data.getDataPath())), "127.0.0.1", 0)
    ((body, joint, slider),) = view._sliders
    pauses: list[float] = []

    def sleep(seconds: float) -> None:
        pauses.append(seconds)
        assert body.joints[joint].position == slider.value
        slider.value += 0.5
        if len(pauses) == 3:
            view.viewer.close()

    monkeypatch.setattr("carom.cli.show_robot.time", SimpleNamespace(sleep=sleep))
    view.run()
    assert pauses == [pytest.approx(1 / 60)] * 3
