"""Sections: what the user does at any moment happens before or after them."""

from __future__ import annotations

import cProfile
import gc
import os
import signal
import sys
import threading
from collections.abc import Iterator
from typing import Any

import pytest

from carom import World
from carom.native.uninterrupted import Quiet, begin, end, uninterrupted

posix = pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")


@pytest.fixture
def heard() -> Iterator[list[int]]:
    numbers: list[int] = []
    before = [signal.signal(number, lambda n, _: numbers.append(n)) for number in _NUMBERS]
    yield numbers
    for number, handler in zip(_NUMBERS, before, strict=True):
        signal.signal(number, handler)


_NUMBERS = (signal.SIGUSR1, signal.SIGUSR2) if os.name == "posix" else ()


@posix
def test_a_handler_runs_at_the_end_of_the_outermost_section(heard: list[int]) -> None:
    with uninterrupted:
        with uninterrupted:
            signal.raise_signal(signal.SIGUSR1)
        assert heard == []
        signal.raise_signal(signal.SIGUSR2)
    assert sorted(heard) == sorted(_NUMBERS)
    signal.raise_signal(signal.SIGUSR1)
    assert heard[2:] == [signal.SIGUSR1]


@posix
def test_handlers_are_shown_as_they_were_set(heard: list[int]) -> None:
    def new(_number: int, _frame: object) -> None:
        heard.append(0)

    handlers: list[Any] = [new, signal.SIG_IGN, signal.SIG_DFL, heard.append]
    for handler in handlers:
        signal.signal(signal.SIGUSR2, handler)
        assert signal.getsignal(signal.SIGUSR2) == handler
        assert signal.signal(signal.SIGUSR2, new) == handler
    signal.raise_signal(signal.SIGUSR2)
    assert heard == [0]
    with pytest.raises(TypeError):
        signal.signal(signal.SIGUSR2, "no handler")  # pyright: ignore[reportArgumentType]


@posix
def test_all_handlers_are_called_also_if_one_raises(heard: list[int]) -> None:
    def raises(number: int, _frame: object) -> None:
        heard.append(number)
        raise LookupError(number)

    for number in _NUMBERS:
        signal.signal(number, raises)
    begin()
    for number in _NUMBERS:
        signal.raise_signal(number)
    with pytest.raises(LookupError):
        end()
    assert sorted(heard) == sorted(_NUMBERS)


@posix
def test_what_a_handler_raises_is_raised_at_the_end(heard: list[int]) -> None:
    def raises(_number: int, _frame: object) -> None:
        raise LookupError

    signal.signal(signal.SIGUSR1, raises)
    begin()
    signal.raise_signal(signal.SIGUSR1)
    with pytest.raises(LookupError):
        end()
    assert signal.getsignal(signal.SIGUSR1) is raises
    with uninterrupted:
        pass
    assert gc.isenabled()


@posix
def test_a_handler_that_is_set_in_a_section_stays(heard: list[int]) -> None:
    def new(_number: int, _frame: object) -> None:
        heard.append(0)

    with uninterrupted:
        signal.raise_signal(signal.SIGUSR1)
        signal.signal(signal.SIGUSR1, new)
    assert signal.getsignal(signal.SIGUSR1) is new
    assert heard == [0]


@posix
def test_ctrl_c_breaks_off_a_section_by_pythons_own_handler() -> None:
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt), uninterrupted:
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)
    assert gc.isenabled()


def test_no_garbage_is_collected_in_a_section_of_any_thread() -> None:
    inside, leave = threading.Event(), threading.Event()

    def other() -> None:
        with uninterrupted:
            inside.set()
            leave.wait()

    thread = threading.Thread(target=other)
    thread.start()
    inside.wait()
    with uninterrupted:
        assert not gc.isenabled()
    assert not gc.isenabled()
    leave.set()
    thread.join()
    assert gc.isenabled()


def test_garbage_stays_uncollected_where_the_user_wants_it() -> None:
    gc.disable()
    try:
        with uninterrupted:
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


def test_trace_functions_are_put_aside_in_a_section() -> None:
    lines: list[str] = []

    def trace(frame: Any, event: str, argument: object) -> Any:
        lines.append(frame.f_code.co_name)
        return trace

    def traced() -> None:
        pass

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        with uninterrupted:
            traced()
        inside = lines.count("traced")
        traced()
        after = lines.count("traced")
        found = sys.gettrace()
    finally:
        sys.settrace(before)
    assert inside == 0
    assert after > 0
    assert found is trace


def test_the_profiler_of_the_standard_library_counts_what_comes_in_and_after_a_section() -> None:
    def called() -> None:
        pass

    profile = cProfile.Profile()
    profile.enable()
    with uninterrupted:
        called()
    called()
    profile.disable()
    counts = [entry.callcount for entry in profile.getstats() if entry.code is called.__code__]
    assert counts == [2]


def test_a_profile_function_hears_nothing_in_a_section() -> None:
    heard: list[str] = []

    def called() -> None:
        pass

    def profile(frame: Any, _event: str, _argument: object) -> None:
        heard.append(frame.f_code.co_name)

    sys.setprofile(profile)
    try:
        with uninterrupted:
            called()
        inside = "called" in heard
        called()
    finally:
        sys.setprofile(None)
    assert not inside
    assert "called" in heard


def test_quiet_work_is_not_searched_for_garbage_and_may_be_nested_with_sections() -> None:
    assert gc.isenabled()
    with Quiet():
        with uninterrupted:
            assert not gc.isenabled()
        assert not gc.isenabled()
        with Quiet():
            pass
        assert not gc.isenabled()
    assert gc.isenabled()
    gc.disable()
    try:
        with Quiet():
            pass
        assert not gc.isenabled()
    finally:
        gc.enable()


@posix
def test_quiet_work_can_be_interrupted(heard: list[int]) -> None:
    with Quiet():
        signal.raise_signal(signal.SIGUSR1)
        assert heard == [signal.SIGUSR1]


def test_files_are_read_quietly() -> None:
    text = "<mujoco><worldbody>" + 50 * '<body><geom size=".1"/></body>' + "</worldbody></mujoco>"
    phases: list[str] = []
    threshold = gc.get_threshold()
    with World() as world:
        world.load("<mujoco/>")
        gc.set_threshold(100)
        gc.callbacks.append(note := lambda phase, _: phases.append(phase))
        try:
            world.load(text)
        finally:
            gc.callbacks.remove(note)
            gc.set_threshold(*threshold)
    # Before and after the reading there may be some.
    assert len(phases) < 20
