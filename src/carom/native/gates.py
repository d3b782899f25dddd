"""Locks of worlds in the native library: builtins take them without a line of Python.

`native/source/changes/gate.h` describes how they work.
"""

from __future__ import annotations

import ctypes
from _thread import allocate_lock
from collections.abc import Callable
from functools import cache, wraps
from operator import attrgetter
from threading import RLock
from typing import Any, TypeVar, cast

from carom.forks import free_in_forks
from carom.layouts.gates import Gate
from carom.native.builtins import defined, descriptor_of
from carom.native.change import Outdated
from carom.native.uninterrupted import uninterrupted

F = TypeVar("F", bound=Callable[..., Any])

_METHODS = {"acquire": "acquire", "release": "release", "__enter__": "acquire", "__exit__": "release"}
_METHODS_OF_CALLS = {"__enter__": "enter_call", "__exit__": "leave_call"}


class GateLock(float):
    """The lock of a world: that of `threading.RLock`, which calls in the native library take as well.

    Its value is the address of its `Gate`, by which C code finds this: a float, because there are no weak
    references to whole numbers.

    Attributes:
        acquire: Takes it, with the arguments of `threading.Lock.acquire`.
        release: Gives it back.
    """

    acquire: Any
    release: Any
    __enter__: Any
    __exit__: Any

    def __new__(cls) -> GateLock:
        """A new lock."""
        gate = Gate()
        lock = super().__new__(cls, ctypes.addressof(gate))
        # Closed until a thread that waits is woken.
        turnstile = allocate_lock()
        turnstile.acquire()
        lock._gate, lock._methods = gate, (turnstile.acquire, turnstile.release)
        gate.wait, gate.wake = map(id, lock._methods)
        return lock

    _gate: Gate
    _methods: tuple[Any, Any]

    def forget_threads(self) -> None:
        """In a forked process: no other thread waits."""
        self._gate.waiting = 0


class CallLock(float):
    """The same lock as calls take it: handlers of signals wait until the outermost call has given it back.

    So a handler can wait for another thread that makes calls. While the user holds the `GateLock`, which may
    be for long, handlers run as with any lock of Python. Its value is the address of the same `Gate`.
    """

    __enter__: Any
    __exit__: Any

    def __new__(cls, lock: GateLock) -> CallLock:
        """What calls take for a lock."""
        made = super().__new__(cls, lock)
        made._lock = lock
        return made

    _lock: GateLock


def new_lock() -> Any:
    """A lock for a world, which the same thread can take again; forks wait for it."""
    return free_in_forks(GateLock() if _has_methods() else RLock(), of_world=True)


def call_lock(lock: Any) -> Any:
    """What calls take for a lock of `new_lock`, with a `with` statement."""
    return CallLock(lock) if isinstance(lock, GateLock) else lock


@cache
def _has_methods() -> bool:
    """Give the classes their methods, which are C code of the library; whether they have them."""
    from carom.native.host import host

    if host is None:
        return False
    for kind, methods in ((GateLock, _METHODS), (CallLock, _METHODS_OF_CALLS)):
        for name, method in methods.items():
            code = host.symbols[f"carom_gate_{method}"]
            setattr(kind, name, descriptor_of(defined(name, code, keywords=True), kind))
    return True


def gated(lock: str, *, section: bool = False, commits: bool = False) -> Callable[[F], F]:
    """Let a function have a world for itself, from its arguments to its result: it holds the gate.

    Args:
        lock: Where the `call_lock` of the world is: attributes of the function's first argument, with points.
        section: No signal handler, finalizer or trace function runs in the middle, either.
        commits: The function commits one change, which has to be the first one since it was called. Signal
            handlers, finalizers and trace functions may change the world in the middle of it. Then the
            function is called again, so that theirs come before it.
    """
    lock_of = attrgetter(lock)
    kind = _that_commits if commits else _in_section if section else _holding

    def guard(function: F) -> F:
        return cast("F", wraps(function)(kind(function, lock_of)))

    return guard


def _holding(function: Callable[..., Any], lock_of: Callable[[Any], Any]) -> Callable[..., Any]:
    def call(first: Any, /, *arguments: Any, **keywords: Any) -> Any:
        with lock_of(first):
            return function(first, *arguments, **keywords)

    return call


def _in_section(function: Callable[..., Any], lock_of: Callable[[Any], Any]) -> Callable[..., Any]:
    def call(first: Any, /, *arguments: Any, **keywords: Any) -> Any:
        with lock_of(first), uninterrupted:
            return function(first, *arguments, **keywords)

    return call


def _that_commits(function: Callable[..., Any], lock_of: Callable[[Any], Any]) -> Callable[..., Any]:
    def call(first: Any, /, *arguments: Any, **keywords: Any) -> Any:
        try:
            with lock_of(first):
                return function(first, *arguments, **keywords)
        except Outdated:
            with lock_of(first):
                return again(function, first, *arguments, **keywords)

    return call


def again(function: Callable[..., Any], *arguments: Any, **keywords: Any) -> Any:
    """Call a function that was `Outdated` until its change is the first one since."""
    # Only other worlds change now, in other threads.
    with uninterrupted:
        while True:
            try:
                return function(*arguments, **keywords)
            except Outdated:
                continue
