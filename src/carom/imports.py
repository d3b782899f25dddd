"""Imports of many modules at once, which Python's garbage collector need not look through again and again.

A hundred modules make tens of thousands of objects that stay. Going through those there are after every few
thousand new ones takes a tenth of the time that a script needs to its first step, and going through all of
them once more, as young ones, when the collector is switched on again, a twentieth.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def uncollected(function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
    """What a function that imports returns; the garbage collector pauses meanwhile, unless it does anyway."""
    collects = pause()
    try:
        return function(*args, **kwargs)
    finally:
        resume(collects=collects)


def pause() -> bool:
    """Let the garbage collector pause; returns whether it did not before, for `resume`."""
    collects = gc.isenabled()
    gc.disable()
    return collects


def resume(*, collects: bool) -> None:
    """End a pause; all objects are old ones from now on, which only full collections go through."""
    if not gc.get_freeze_count():
        # The quickest way of making objects old; those that users have frozen stay frozen.
        gc.freeze()
        gc.unfreeze()
    if collects:
        gc.enable()
