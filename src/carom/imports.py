"""Imports of many modules at once, which Python's garbage collector need not look through again and again.

A hundred modules make tens of thousands of objects that stay; going through those there are after every few
thousand new ones takes a tenth of the time that a script needs to its first step.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def uncollected(function: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R:
    """What a function that imports returns; the garbage collector pauses meanwhile, unless it does anyway."""
    collects = gc.isenabled()
    try:
        gc.disable()
        return function(*args, **kwargs)
    finally:
        if collects:
            gc.enable()
