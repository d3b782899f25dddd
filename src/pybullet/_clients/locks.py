"""The locks of worlds: each is held from the arguments of a call to its results, see `_calls.conduct`."""

from __future__ import annotations

from typing import Any

from carom.native.gates import new_lock
from pybullet._calls.quick import install

# By id of the connection. None is ever freed: a call may be waiting for it when its connection ends.
_locks: dict[int, Any] = {}


def lock_of(number: int) -> Any:
    """The lock for the world of a connection, which calls take from now on until `let_go`."""
    lock = _locks.get(number)
    calls = install()
    if lock is None:
        lock = _locks.setdefault(number, new_lock())
    if calls is not None:
        # The value of a `GateLock` is the address of its gate.
        calls.gates[number] = int(lock)
    return lock


def let_go(number: int) -> None:
    """Calls that name a connection, which has ended, take no lock any more."""
    calls = install() if number in _locks else None
    if calls is not None:
        calls.gates[number] = None
