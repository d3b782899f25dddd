"""Handlers of signals come before or after a call, never in it.

Python runs a handler between any two lines of the main thread, also where a call holds a lock of ours. A
handler that waits there for another thread (it stops and joins it, or takes a lock of the user's that it
holds) would wait for ever, because that thread waits for the call. So Python is given a function of ours for
each handler of the user, which calls it at once, or at the end of the call in which the signal has come
(`native/source/changes/handlers.h`). `signal.getsignal` and `signal.signal` go on to show the user's.

Python's own handler of Ctrl-C is left alone: it raises `KeyboardInterrupt`, and that ends a long call.

A call of many steps has turns (`handler_waits`): between two, it gives the lock up while handlers run. A step
that takes long by itself is broken off for them, and taken again (`native/source/watch.h`).
"""

from __future__ import annotations

import _signal  # pyright: ignore[reportMissingImports]
import ctypes
import os
import threading
import time
from _thread import get_ident
from collections.abc import Callable
from types import BuiltinFunctionType
from typing import Any, ClassVar

from carom.layouts.gates import Waiting
from carom.native.builtins import MethodDefinition, builtin_of, defined

_NAME = "handle_signal"
_set_handler: Callable[[int, Any], Any] = _signal.signal
_handler_of: Callable[[int], Any] = _signal.getsignal


class Handlers:
    """What is known of handlers of signals and of calls of the main thread.

    Attributes:
        waiting: Whether handlers wait: a record, which C code reads and writes.
        arrived: The signals that have come in a call, with the frames in which they did.
        definition: The C code that is given to Python; None while the library has not been loaded.
        are_ours: Handlers that were set before this module was imported have been replaced, too.
    """

    waiting: ClassVar[Any] = Waiting()
    arrived: ClassVar[dict[int, Any]] = {}
    definition: ClassVar[MethodDefinition | None] = None
    are_ours: ClassVar[bool] = False


class _Handler:
    """What the C code does, where there is none."""

    def __init__(self, handler: Callable[[int, Any], Any]) -> None:
        self.handler = handler

    def __call__(self, number: int, frame: Any) -> None:
        waiting = Handlers.waiting
        if waiting.calls > 0 or waiting.in_section:
            Handlers.arrived[number] = frame
            waiting.arrived = 1
        else:
            self.handler(number, frame)


def is_main_thread() -> bool:
    """Whether signals are handled in this thread; the first time, let handlers of the user wait."""
    if get_ident() != Handlers.waiting.main_thread:
        return False
    if not Handlers.are_ours:
        _replace_all()
    return True


def begin_section() -> None:
    """Let handlers wait until `end_section`, which the main thread calls."""
    Handlers.waiting.in_section = 1


def end_section() -> None:
    """Let them wait no longer; can be repeated."""
    Handlers.waiting.in_section = 0


def handler_waits() -> bool:
    """Whether a handler waits for the end of a call of the main thread."""
    return bool(Handlers.waiting.arrived)


def deliver_at_end() -> None:
    """In the main thread, after a section: call handlers that have waited, unless it is part of a call.

    Raises:
        BaseException: What a handler raises.
    """
    waiting = Handlers.waiting
    if waiting.arrived and not waiting.calls:
        deliver()


def deliver() -> None:
    """Call the handlers of signals that have arrived; all of them, also if one raises an error."""
    Handlers.waiting.arrived = 0
    try:
        number, frame = Handlers.arrived.popitem()
    except KeyError:
        return
    try:
        handler = _handler_of(number)
        if callable(handler):
            handler(number, frame)
    finally:
        deliver()


def meet_library(symbols: Any) -> None:
    """Let C code of the library do it from now on."""
    before = Handlers.waiting
    waiting = Waiting.in_dll(symbols, "carom_waiting")
    for name in Waiting.fields:
        setattr(waiting, name, getattr(before, name))
    symbols.carom_meet_handlers.argtypes = [ctypes.py_object] * 2
    symbols.carom_meet_handlers(Handlers.arrived, deliver)
    _meet_clock(symbols)
    Handlers.definition = defined(_NAME, symbols.carom_handle_signal)
    Handlers.waiting = waiting
    Handlers.are_ours = False
    is_main_thread()


def _meet_clock(symbols: Any) -> None:
    """Let the library see in long steps whether a signal has come; on Windows it has no clock for that."""
    if os.name == "posix":
        clock = ctypes.addressof(ctypes.c_char.in_dll(ctypes.pythonapi, "clock_gettime"))
        symbols.carom_meet_clock.argtypes = [ctypes.c_void_p, ctypes.c_int]
        symbols.carom_meet_clock(clock, time.CLOCK_MONOTONIC)


def _ours(handler: Any) -> Any:
    """What Python gets in place of a handler."""
    if not callable(handler) or handler is _signal.default_int_handler:
        return handler
    if Handlers.definition is None:
        return _Handler(handler)
    return builtin_of(Handlers.definition, handler, __name__)


def _users(handler: Any) -> Any:
    """The handler of the user that Python has got this for."""
    if type(handler) is _Handler:
        return handler.handler
    is_ours = (
        type(handler) is BuiltinFunctionType and handler.__name__ == _NAME and handler.__module__ == __name__
    )
    return handler.__self__ if is_ours else handler


def _replace_all() -> None:
    Handlers.are_ours = True
    for number in _signal.valid_signals():
        there = _handler_of(number)
        ours = _ours(_users(there))
        if ours is not there:
            try:
                _set_handler(number, ours)
            except ValueError:
                # Not in the main interpreter, where no handlers run.
                return


def _signal_(signalnum: int, handler: Any, /) -> Any:
    return _users(_set_handler(signalnum, _ours(handler)))


def _getsignal(signalnum: int, /) -> Any:
    return _users(_handler_of(signalnum))


def _keep_main_thread() -> None:
    """In a forked process, the thread that has forked is the main thread."""
    waiting = Handlers.waiting
    if waiting.main_thread != get_ident():
        waiting.main_thread = get_ident()
        waiting.calls = waiting.in_section = 0


def _install() -> None:
    Handlers.waiting.main_thread = threading.main_thread().ident or 0
    for name, function in (("signal", _signal_), ("getsignal", _getsignal)):
        original = getattr(_signal, name)
        function.__name__, function.__qualname__ = name, name
        function.__module__, function.__doc__ = original.__module__, original.__doc__
        setattr(_signal, name, function)
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=_keep_main_thread)
    is_main_thread()


_install()
