"""Sections of a program that nothing of the user interrupts.

In Python, a signal handler may run between any two lines of the main thread, a finalizer wherever memory is
allocated, a trace function at every line. In a section they do not: handlers run at its end, garbage is
collected later, and trace functions wait. So none of them sees half a change.

Ctrl-C is the exception while its handler is Python's own, which raises `KeyboardInterrupt`: it ends a long
call. What it breaks off has not happened, see `carom.native.change`.
"""

from __future__ import annotations

import _signal  # pyright: ignore[reportMissingImports]
import gc
import sys
import threading
from _thread import allocate_lock, get_ident
from collections.abc import Callable
from types import TracebackType
from typing import Any, ClassVar

_SIGNALS = tuple(sorted(int(number) for number in _signal.valid_signals()))
# Frames of these are part of a call.
_OUR_PACKAGES = frozenset({"carom", "pybullet", "numpy"})
_HANDLER_OF_PYTHON = _signal.default_int_handler


class _State:
    """What sections have put aside.

    Attributes:
        depths: The number of sections that a thread is in, by thread.
        seen: The handlers of all signals, as they were found last.
        same_handlers: Whether these, given the signals and `seen`, are the present ones; see `handlers.cpp`.
        users: Those of them that are functions of the user, by signal.
        handlers: The same while the main thread is in a section.
        arrived: The signals that have come since, with the frames in which they did.
        note: Notes a signal; as a function in C it runs no line of Python.
        tracers: The trace function and the profile function by thread, of those that have any; None for none.
        quiet: The threads in whose sections no garbage is collected.
        collects: Whether it was collected before the first of these began.
        changing: Held while these two change.
        keeps_tracing: Trace functions go on. Tests raise errors at any line by means of them.
    """

    depths: ClassVar[dict[int, int]] = {}
    seen: ClassVar[list[Any]] = []
    same_handlers: Callable[[tuple[int, ...], list[Any]], bool] | None = None
    users: ClassVar[dict[int, Callable[[int, Any], Any]]] = {}
    handlers: ClassVar[dict[int, Callable[[int, Any], Any]]] = {}
    arrived: ClassVar[dict[int, Any]] = {}
    note: Any = arrived.__setitem__
    tracers: ClassVar[dict[int, tuple[Any, Any]]] = {}
    quiet: ClassVar[set[int]] = set()
    collects = True
    changing = allocate_lock()
    keeps_tracing = False


def begin() -> int:
    """Begin a section; sections may be nested.

    Returns:
        The number of sections that the thread was in before.

    Raises:
        BaseException: What the handler of a signal raises that came before; the section has not begun.
    """
    thread = get_ident()
    depth = _State.depths.get(thread, 0)
    _State.depths[thread] = depth + 1
    if depth:
        return depth
    try:
        if thread == threading.main_thread().ident:
            _put_handlers_aside()
        if not _State.keeps_tracing and (sys.gettrace() or sys.getprofile()):
            _put_tracers_aside(thread)
        with _State.changing:
            if not _State.quiet:
                _State.collects = gc.isenabled()
            _State.quiet.add(thread)
            gc.disable()
    except BaseException:
        _finish(thread)
        raise
    return depth


def end(outside: int | None = None) -> None:
    """End a section; at the end of the outermost one, call the handlers of signals that have come in it.

    Args:
        outside: What `begin` returned. Then it can be repeated, and ends sections inside, too: Ctrl-C may
            come when their end has been called and has done nothing yet.

    Raises:
        BaseException: What a handler raises.
    """
    thread = get_ident()
    if outside is None:
        outside = _State.depths[thread] - 1
    if outside:
        _State.depths[thread] = outside
        return
    try:
        _finish(thread)
    except BaseException:
        # Ctrl-C may come here, too; all steps can be repeated.
        _finish(thread)
        raise
    if _State.arrived and thread == threading.main_thread().ident:
        _deliver()


class Section:
    """A section as a context manager."""

    __slots__ = ()

    __enter__ = staticmethod(begin)

    def __exit__(self, *_: object) -> None:
        end()


def ask_natively(same_handlers: Any) -> None:
    """Let the native library find out whether users have set handlers of signals."""
    _State.same_handlers = same_handlers


def in_section() -> bool:
    """Whether this thread is in a section."""
    return get_ident() in _State.depths


uninterrupted = Section()
"""`with uninterrupted:` is a section."""


def is_our_own(_kind: object, _error: object, traceback: TracebackType | None) -> bool:
    """Whether an error was raised by code of Carom, and not by that of a user which interrupted it."""
    while traceback is not None:
        package = str(traceback.tb_frame.f_globals.get("__name__")).partition(".")[0]
        if package not in _OUR_PACKAGES and package not in sys.stdlib_module_names:
            return False
        traceback = traceback.tb_next
    return True


def _finish(thread: int) -> None:
    """Put everything back; can be repeated."""
    with _State.changing:
        _State.quiet.discard(thread)
        if _State.collects and not _State.quiet:
            gc.enable()
    if thread in _State.tracers:
        trace, profile = _State.tracers[thread]
        if profile:
            sys.setprofile(profile)
        if trace:
            sys.settrace(trace)
        _State.tracers.pop(thread, None)
    if _State.handlers and thread == threading.main_thread().ident:
        _bring_handlers_back()
    _State.depths.pop(thread, None)


def _put_handlers_aside() -> None:
    if _State.same_handlers is None or not _State.same_handlers(_SIGNALS, _State.seen):
        handlers = [*map(_signal.getsignal, _SIGNALS)]
        _State.users = {
            number: handler
            for number, handler in zip(_SIGNALS, handlers, strict=True)
            if callable(handler) and handler is not _HANDLER_OF_PYTHON
        }
        _State.seen = handlers
    for number, handler in _State.users.items():
        _State.handlers[number] = handler
        try:
            _signal.signal(number, _State.note)
        except ValueError:
            # Not in the main interpreter, where no handlers run.
            _State.handlers.clear()
            return


def _bring_handlers_back() -> None:
    error = None
    while _State.handlers:
        number, handler = next(iter(_State.handlers.items()))
        # A callback may have set another one meanwhile.
        if _signal.getsignal(number) == _State.note:
            try:
                _signal.signal(number, handler)
            except BaseException as problem:
                # A handler that is back has raised it; the next turn tries this one again.
                error = problem
                continue
        _State.handlers.pop(number, None)
    if error is not None:
        raise error


def _deliver() -> None:
    while _State.arrived:
        number, frame = _State.arrived.popitem()
        handler = _signal.getsignal(number)
        if callable(handler):
            handler(number, frame)


def _put_tracers_aside(thread: int) -> None:
    """Put functions of the user aside; `cProfile`, which runs no code of the user, could not be put back."""
    trace, profile = sys.gettrace(), sys.getprofile()
    _State.tracers[thread] = trace if callable(trace) else None, profile if callable(profile) else None
    if callable(trace):
        sys.settrace(None)
    if callable(profile):
        sys.setprofile(None)
