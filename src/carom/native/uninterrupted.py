"""Sections of a program that nothing of the user interrupts.

In Python, a signal handler may run between any two lines of the main thread, a finalizer wherever memory is
allocated, a trace function at every line. In a section they do not: handlers run at its end, garbage is
collected later, and trace functions wait. So none of them sees half a change.

Ctrl-C is the exception while its handler is Python's own, which raises `KeyboardInterrupt`: it ends a long
call. What it breaks off has not happened, see `carom.native.change`.
"""

from __future__ import annotations

import gc
import sys
from _thread import allocate_lock, get_ident
from types import TracebackType
from typing import Any, ClassVar

from carom.native import handlers

# Frames of these are part of a call.
_OUR_PACKAGES = frozenset({"carom", "pybullet", "numpy"})


class _State:
    """What sections have put aside.

    Attributes:
        depths: The number of sections that a thread is in, by thread.
        tracers: The trace function and the profile function by thread, of those that have any; None for none.
        quiet: The threads in whose sections no garbage is collected, and each `Quiet`.
        collects: Whether it was collected before the first of these began.
        changing: Held while these two change.
        keeps_tracing: Trace functions go on. Tests raise errors at any line by means of them.
    """

    depths: ClassVar[dict[int, int]] = {}
    tracers: ClassVar[dict[int, tuple[Any, Any]]] = {}
    quiet: ClassVar[set[object]] = set()
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
        if handlers.is_main_thread():
            handlers.begin_section()
        if not _State.keeps_tracing and (sys.gettrace() or sys.getprofile()):
            _put_tracers_aside(thread)
        _collect_later(thread)
    except BaseException:
        _finish(thread)
        raise
    return depth


def end(outside: int | None = None) -> None:
    """End a section; at the end of the outermost one, call the handlers of signals that have come in it.

    In a call that holds the lock of a world, they are called at its end (`carom.native.gates`).

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
    if handlers.is_main_thread():
        handlers.deliver_at_end()


class Section:
    """A section as a context manager."""

    __slots__ = ()

    __enter__ = staticmethod(begin)

    def __exit__(self, *_: object) -> None:
        end()


class Quiet:
    """As a context manager: garbage is collected later, as in a section; all else may interrupt it.

    It is for work that makes many objects which stay: to search them for garbage again and again takes time.
    """

    def __enter__(self) -> None:
        try:
            _collect_later(self)
        except BaseException:
            _collect_again(self)
            raise

    def __exit__(self, *_: object) -> None:
        try:
            _collect_again(self)
        except BaseException:
            _collect_again(self)
            raise


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


def _collect_later(whose: object) -> None:
    with _State.changing:
        if not _State.quiet:
            _State.collects = gc.isenabled()
        _State.quiet.add(whose)
        gc.disable()


def _collect_again(whose: object) -> None:
    """Unless others want it later; can be repeated."""
    with _State.changing:
        _State.quiet.discard(whose)
        if _State.collects and not _State.quiet:
            gc.enable()


def _finish(thread: int) -> None:
    """Put everything back; can be repeated."""
    _collect_again(thread)
    if thread in _State.tracers:
        trace, profile = _State.tracers[thread]
        if profile:
            sys.setprofile(profile)
        if trace:
            sys.settrace(trace)
        _State.tracers.pop(thread, None)
    if handlers.is_main_thread():
        handlers.end_section()
    _State.depths.pop(thread, None)


def _put_tracers_aside(thread: int) -> None:
    """Put functions of the user aside; `cProfile`, which runs no code of the user, could not be put back."""
    trace, profile = sys.gettrace(), sys.getprofile()
    _State.tracers[thread] = trace if callable(trace) else None, profile if callable(profile) else None
    if callable(trace):
        sys.settrace(None)
    if callable(profile):
        sys.setprofile(None)
