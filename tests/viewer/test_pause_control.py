"""The gate for steps while a simulation is paused."""

from threading import Thread

from tests.patience import PATIENCE

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
        thread = Thread(target=lambda listening=listening: ends.append(gate.wait(listening=listening)))
        thread.start()
        while listening and not gate.listeners:
            pass
        act()
        thread.join(PATIENCE)
    assert ends == [True, False, True]
