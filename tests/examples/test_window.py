"""Windows of the tutorials' scripts, by a clock of our own."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

import pybullet as p
from carom.examples import window


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
