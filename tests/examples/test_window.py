"""Windows of the tutorials' scripts, by a clock of our own."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

import pybullet as p
from carom.examples import robot_file, window


@pytest.mark.parametrize("shown", [True, False])
def test_steps_are_in_real_time_where_there_is_a_window(monkeypatch: pytest.MonkeyPatch, shown: bool) -> None:
    now, pauses = 100.0, []

    def sleep(seconds: float) -> None:
        nonlocal now
        pauses.append(seconds)
        now += seconds

    monkeypatch.setattr(window, "time", SimpleNamespace(perf_counter=lambda: now, sleep=sleep))
    client = p.connect(p.DIRECT)
    taken = []
    for step in window.steps(4 * window.TIME_STEP, shown):
        taken.append(step)
        # What the script itself takes: the third step is late, which the fourth makes up for.
        now += (0.001, 0.001, 0.006, 0.001)[step]
    p.disconnect(client)
    assert taken == [0, 1, 2, 3]
    rest = window.TIME_STEP - 0.001
    late = 0.006 - window.TIME_STEP
    assert pauses == (pytest.approx([rest, rest, 0.0, rest - late]) if shown else [])


def test_a_step_is_that_of_the_simulation() -> None:
    assert window.TIME_STEP == 1 / 240


@pytest.mark.parametrize("words", [[], ["--headless"]])
def test_a_script_asks_for_a_window_unless_it_is_told_not_to(
    monkeypatch: pytest.MonkeyPatch, words: list[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["script.py", *words])
    assert window.wants_window() == (not words)


@pytest.mark.parametrize(("shown", "way"), [(True, p.GUI), (False, p.DIRECT)])
def test_the_number_of_the_connection_is_returned(
    monkeypatch: pytest.MonkeyPatch, shown: bool, way: int
) -> None:
    asked: list[int] = []
    monkeypatch.setattr(window.p, "connect", lambda asking: asked.append(asking) or 7)
    assert window.connect(shown) == 7
    assert asked == [way]


def test_the_steps_end_when_the_user_presses_esc_or_the_connection_ends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    client, keys = p.connect(p.DIRECT), {}
    monkeypatch.setattr(window.p, "getKeyboardEvents", lambda: keys)
    taken = []
    for step in window.steps(1.0, window=False):
        taken.append(step)
        if step == 2:
            keys[27] = p.KEY_IS_DOWN
    assert taken == [0, 1, 2]
    keys.clear()
    step = -1
    for step in window.steps(1.0, window=False):
        if step == 1:
            p.disconnect(client)
    assert step == 1


@pytest.mark.parametrize("number", [0, 3, -1])
def test_a_button_says_once_that_it_was_pressed(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    made, presses = [], {number: 0.0}
    monkeypatch.setattr(window.p, "addUserDebugParameter", lambda *them: made.append(them) or number)
    monkeypatch.setattr(window.p, "readUserDebugParameter", lambda asked: presses[asked])
    pressed = window.button("go")
    assert made == [("go", 1, 0, 0)]
    assert not pressed()
    presses[number] = 1.0
    assert [pressed(), pressed()] == [number >= 0, False]


@pytest.mark.parametrize("number", [0, 3, -1])
def test_a_slider_has_its_start_value_where_there_is_no_window(
    monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    made = []
    monkeypatch.setattr(window.p, "addUserDebugParameter", lambda *them: made.append(them) or number)
    monkeypatch.setattr(window.p, "readUserDebugParameter", {number: 0.25}.get)
    assert window.slider("angle", -1.0, 2.0, 0.5)() == (0.25 if number >= 0 else 0.5)
    assert made == [("angle", -1.0, 2.0, 0.5)]


def test_robots_of_the_tutorials_are_found_by_their_names() -> None:
    assert Path(robot_file("one_joint_arm.urdf")).is_file()
    with pytest.raises(FileNotFoundError, match=r"named 'arm'; expected one of .*one_joint_arm\.urdf"):
        robot_file("arm")
