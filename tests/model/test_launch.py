"""Recorded launches and the notice about compiling."""

import numpy as np
import pytest
import warp as wp

from carom.model import launch as launching
from carom.model.launch import CompilationNotice, Launch
from carom.model.real import Int32, RealRows, kernel


@kernel
def add_kernel(values: RealRows, amount: Int32, column: Int32):
    """Add `amount` to one column of each row."""
    row = wp.tid()
    values[row, column] = values[row, column] + wp.float64(amount)


@pytest.fixture
def values() -> np.ndarray:
    return np.zeros((3, 2))


@pytest.fixture
def launch(values) -> Launch:
    rows = wp.array2d(values, dtype=wp.float64, device="cpu", copy=False)
    return Launch(add_kernel, 3, [rows, 5, 1])


def test_making_a_launch_runs_nothing(launch, values):
    assert launch.function is not None
    assert not values.any()


def test_it_runs_on_the_memory_it_was_given_again_and_again(launch, values):
    launch()
    launch()
    np.testing.assert_array_equal(values, [[0.0, 10.0]] * 3)
    values[1, 1] = 0.5
    launch()
    np.testing.assert_array_equal(values[:, 1], [15.0, 5.5, 15.0])


def test_replaced_scalars_hold_for_all_later_runs(launch, values):
    launch.replace(1, 7)
    launch.replace(2, 0)
    launch()
    launch()
    np.testing.assert_array_equal(values, [[14.0, 0.0]] * 3)


def test_its_function_is_the_run_itself(launch, values):
    run = launch.function
    run()
    launch.replace(1, 1)
    run()
    np.testing.assert_array_equal(values[:, 1], 6.0)


def test_it_keeps_its_arrays_alive(values):
    launches = [
        Launch(add_kernel, 1, [wp.array2d(values, dtype=wp.float64, device="cpu", copy=False), n, 0])
        for n in range(3)
    ]
    for launch in launches:
        launch()
    assert values[0, 0] == 3.0


class ImpatientTimer:
    """A timer that is up at once."""

    daemon = False

    def __init__(self, _seconds, function) -> None:
        self.function = function

    def start(self) -> None:
        self.function()

    def cancel(self) -> None:
        self.is_cancelled = True


class PatientTimer(ImpatientTimer):
    """A timer that is never up."""

    def start(self) -> None:
        self.daemon = True


def test_long_compilations_are_announced_on_stderr(monkeypatch, capsys):
    monkeypatch.setattr(launching.threading, "Timer", ImpatientTimer)
    with CompilationNotice():
        pass
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "compiling the physics kernels" in printed.err
    assert "once" in printed.err
    assert "kernels compiled in" in printed.err


def test_short_ones_are_not(monkeypatch, capsys):
    monkeypatch.setattr(launching.threading, "Timer", PatientTimer)
    with CompilationNotice():
        pass
    assert capsys.readouterr().err == ""
