"""Locks of worlds in the native library: builtins take them without a line of Python.

`native/source/gate.h` describes how they work.
"""

from __future__ import annotations

import ctypes
from _thread import allocate_lock
from collections.abc import Callable
from typing import Any

from carom.layouts.gates import Gate

# Builds `(name, address of the C code, self) -> builtin`.
BuiltinMaker = Callable[[str, int, Any], Any]


class GateLock:
    """The lock of a world: that of `threading.RLock`, which calls in the native library take as well.

    Attributes:
        acquire: Takes it, with the arguments of `threading.Lock.acquire`.
        release: Gives it back.
        address: Address of the `Gate`.
    """

    __slots__ = ("_gate", "_methods", "_turnstile", "acquire", "address", "release")

    # Set by the subclass that `lock_of` makes for each lock: builtins that know its address.
    __enter__: Any
    __exit__: Any

    def __init__(self, gate: Gate, acquire: Any, release: Any) -> None:
        # Closed until a thread that waits is woken.
        self._turnstile = allocate_lock()
        self._turnstile.acquire()
        self._methods = self._turnstile.acquire, self._turnstile.release
        self._gate = gate
        gate.wait, gate.wake = map(id, self._methods)
        self.address: int = ctypes.addressof(gate)
        self.acquire = acquire
        self.release = release

    def forget_threads(self) -> None:
        """In a forked process: no other thread waits."""
        self._gate.waiting = 0


def lock_of(symbols: Any, new_builtin: BuiltinMaker) -> GateLock:
    """A new lock; it must be kept as long as the library knows its gate."""
    gate = Gate()
    address = ctypes.addressof(gate)
    acquire, release = (
        new_builtin(name, _address(symbols, f"carom_gate_{name}"), address) for name in ("acquire", "release")
    )
    # Builtins do not bind, so `with` calls them as they are.
    methods = {"__slots__": (), "__enter__": acquire, "__exit__": release}
    return type("GateLock", (GateLock,), methods)(gate, acquire, release)


def _address(symbols: Any, name: str) -> int:
    return ctypes.cast(symbols[name], ctypes.c_void_p).value or 0
