"""The builtin that performs a step of a world: the step and the world's clock change by one native call."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import cache
from typing import Any

from carom.native.builtins import MethodDefinition, builtin_of, defined


class _Address(float):
    """The address of a record, which it keeps; a float, as C code reads it without an error."""

    record: Any


def step_taker(record: Any) -> Callable[[], bool]:
    """A function that performs the step of a `layouts.quick_world.Step`, and returns whether it has.

    While the record has no address of a step, and where there are no builtins, it does nothing.
    """
    definition = _definition()
    if definition is None:
        return bool
    address = _Address(ctypes.addressof(record))
    address.record = record
    return builtin_of(definition, address, "carom")


@cache
def _definition() -> MethodDefinition | None:
    from carom.native.host import host

    return None if host is None else defined("take_step", host.symbols.carom_take_step)
