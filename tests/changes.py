"""Changes that consist of one part only."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Concatenate, ParamSpec, TypeVar

from carom.native.change import Change

P = ParamSpec("P")
T = TypeVar("T")


def at_once(note: Callable[Concatenate[Change, P], T], *arguments: P.args, **keywords: P.kwargs) -> T:
    """Makes the change that a function notes, and returns what this returns."""
    change = Change()
    result: Any = note(change, *arguments, **keywords)
    change.commit()
    return result
