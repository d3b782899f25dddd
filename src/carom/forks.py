"""Locks that a forked process gets as free as its parent's.

A fork copies one thread only, and a lock that another thread holds would never be released in the child. So a
fork waits until it is free; then what it protects is not half done either.
"""

from __future__ import annotations

import os
from typing import Any
from weakref import WeakValueDictionary

# By their `id`. Those of worlds are taken before those of caches, which calls take meanwhile.
_worlds: WeakValueDictionary[int, Any] = WeakValueDictionary()
_caches: WeakValueDictionary[int, Any] = WeakValueDictionary()
_held: list[Any] = []


def free_in_forks(lock: Any, *, of_world: bool = False) -> Any:
    """Let forks wait for a lock, which the same thread can take again; returns it."""
    (_worlds if of_world else _caches)[id(lock)] = lock
    return lock


def _take() -> None:
    # Another thread may have one world and want a second one. So only the first is waited for, while none is
    # held: if one of the others is taken, all are given back, and that one is waited for.
    worlds = _living(_worlds)
    while not all(lock.acquire(not place) and not _held.append(lock) for place, lock in enumerate(worlds)):
        taken = worlds.pop(len(_held))
        _give_back()
        worlds.insert(0, taken)
    for lock in _living(_caches):
        lock.acquire()
        _held.append(lock)


def _living(locks: WeakValueDictionary[int, Any]) -> list[Any]:
    return [lock for known in locks.valuerefs() if (lock := known()) is not None]


def _give_back() -> None:
    while _held:
        _held.pop().release()


def _give_back_in_child() -> None:
    for lock in _living(_worlds):
        forget_threads = getattr(lock, "forget_threads", None)
        if forget_threads is not None:
            forget_threads()
    _give_back()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_take, after_in_parent=_give_back, after_in_child=_give_back_in_child)
