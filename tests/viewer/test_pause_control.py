"""The gate for steps while a simulation is paused or slowed down."""

from collections.abc import Callable
from math import inf
from threading import Semaphore, Thread
from typing import Any

import pytest
from tests.patience import PATIENCE

from carom.viewer.steps import pause_control
from carom.viewer.steps.pause_control import PauseControl


def test_each_step_that_is_allowed_is_made_once():
    gate = PauseControl()
    assert gate.passes()
    gate.close()
    assert not gate.passes()
    gate.let_through()
    gate.let_through()
    assert [gate.passes() for _ in range(3)] == [True, True, False]


def test_a_new_pause_forgets_steps_that_were_allowed_before():
    gate = PauseControl()
    gate.close()
    gate.let_through()
    gate.open()
    assert gate.passes()
    gate.close()
    assert not gate.passes()


def test_a_wait_ends_by_a_step_or_for_input_or_when_the_pause_does():
    gate, ends = PauseControl(), []
    gate.close()
    for act, listening in ((gate.let_through, False), (gate.call_back, True), (gate.open, False)):
        thread = Thread(
            target=lambda listening=listening: ends.append(gate.wait(lambda: 0.0, listening=listening))
        )
        thread.start()
        while listening and not gate.listeners:
            pass
        act()
        thread.join(PATIENCE)
    assert ends == [True, False, True]


def test_who_listens_counts_once_however_often_it_looks(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(pause_control, "_LOOK", 0.001)
    gate, looks = PauseControl(), Semaphore(0)
    monkeypatch.setattr(gate, "_time_left", lambda _clock: (looks.release(), inf if gate.closed else 0.0)[1])
    gate.close()
    thread = Thread(target=lambda: gate.wait(lambda: 0.0, listening=True), daemon=True)
    thread.start()
    for _ in range(5):
        assert looks.acquire(timeout=PATIENCE)
    with gate._changed:
        assert gate.listeners == 1
    gate.open()
    thread.join(PATIENCE)
    assert gate.listeners == 0


def ends_of_a_slow_step(*acts: Callable[[PauseControl], Any]) -> list[bool]:
    """How a wait ends for a step that is due in two hours, when something changes meanwhile."""
    gate, ends = PauseControl(), []
    gate.set_speed(1e-4)
    assert gate.wait(lambda: 0.0)
    thread = Thread(target=lambda: ends.append(gate.wait(lambda: 1.0, listening=True)), daemon=True)
    thread.start()
    for act in acts:
        thread.join(0.01)
        assert thread.is_alive()
        act(gate)
    thread.join(PATIENCE)
    return ends


def test_a_slow_simulation_follows_at_once_when_its_speed_changes():
    assert ends_of_a_slow_step(lambda gate: gate.set_speed(None)) == [True]
    # A new speed counts from now.
    assert ends_of_a_slow_step(lambda gate: gate.set_speed(1e-3)) == [True]
    assert ends_of_a_slow_step(PauseControl.open) == [True]


def test_a_slow_simulation_that_is_paused_makes_no_step_until_it_is_let_through():
    assert ends_of_a_slow_step(PauseControl.close, PauseControl.let_through) == [True]
    assert ends_of_a_slow_step(PauseControl.close, PauseControl.call_back) == [False]


def test_input_does_not_take_steps_from_a_slow_simulation():
    assert ends_of_a_slow_step(PauseControl.call_back, PauseControl.open) == [True]
