"""Locks that a forked process gets as free as its parent's.

A fork copies one thread only, and a lock that another thread holds would never be released in the child. So a
fork waits until it is free; then what it protects is not half done either.
"""

from __future__ import annotations

import os
from typing import Any
from weakref import WeakSet

# Locks are taken in this order: that of a world before those of caches, which calls take meanwhile.
_worlds: list[Any] = []
_caches: WeakSet[Any] = WeakSet()
_held: list[Any] = []


def free_in_forks(lock: Any, *, of_world: bool = False) -> Any:
    """Let forks wait for a lock, which the same thread can take again; returns it.

    The lock of a world is kept for ever.
    """
    if of_world:
        _worlds.append(lock)
    else:
        _caches.add(lock)
    return lock


def _take() -> None:
    for lock in (*_worlds, *_caches):
        lock.acquire()
        _held.append(lock)


def _give_back() -> None:
    while _held:
        _held.pop().release()


def _give_back_in_child() -> None:
    for lock in _worlds:
        forget_threads = getattr(lock, "forget_threads", None)
        if forget_threads is not None:
            forget_threads()
    _give_back()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_take, after_in_parent=_give_back, after_in_child=_give_back_in_child)
