"""Builtins that run kernels in one native call: one performs a step of a world, others ask about a body."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from carom.layouts.programs import Question
from carom.native.builtins import MethodDefinition, builtin_of, defined
from carom.native.launch import Launch

Asker = Callable[..., Any]


class Asked(NamedTuple):
    """A list of numbers in a question.

    Attributes:
        numbers: Where the kernel reads them.
        is_required: They are not 0 if they are left out.
    """

    numbers: np.ndarray
    is_required: bool = True


class _Address(float):
    """The address of a record, which it keeps together with what the record points to."""

    kept: Any


def asker(
    lock: float,
    launch: Launch,
    parts: Sequence[Asked],
    answer: np.ndarray,
    views: Sequence[np.ndarray],
    quaternion: np.ndarray | None = None,
) -> Asker:
    """A function that asks a kernel, given lists of numbers, and returns copies of its answer.

    Args:
        lock: The lock of the world, whose value is the address of its gate.
        launch: The kernel with its arguments.
        parts: The lists, one for each argument of the function; they are plain lists, tuples, or arrays.
        answer: Where the kernel writes its answer, first number NaN if any is not finite; not empty.
        views: Views of the answer. The function returns a copy of each, a number for one without axes; for
            several a tuple.
        quaternion: Numbers of the question that may not all be 0.

    Returns:
        The function. It returns None, having done nothing, if the arguments are not so many finite numbers,
            if the answer is not finite, while another thread has the lock, and where there are no builtins.
    """
    definition = _ask_definition() if len(answer) else None
    if definition is None:
        return _decline
    makers = tuple(view.copy if view.ndim else view.item for view in views)
    record = Question(part_count=len(parts), makers=id(makers))
    record.gate = int(lock)
    record.call.function, record.call.bounds, record.call.arguments = launch.addresses()
    for part, asked in zip(record.parts, parts, strict=False):
        part.numbers, part.count = asked.numbers.ctypes.data, len(asked.numbers)
        part.is_required = asked.is_required
    record.quaternion = None if quaternion is None else quaternion.ctypes.data
    record.answer, record.answer_count = answer.ctypes.data, len(answer)
    address = _Address(ctypes.addressof(record))
    address.kept = record, lock, launch, parts, answer, makers, quaternion
    return builtin_of(definition, address, "carom")


def _decline(*parts: Any) -> None:
    """Answer no question."""


@cache
def _ask_definition() -> MethodDefinition | None:
    from carom.native.host import host

    if host is None:
        return None
    # Instances of other types are left to Python.
    for kind in (np.ndarray, np.float64):
        host.python[kind.__name__].value = id(kind)
    return defined("ask", host.symbols.carom_ask)


def step_taker(record: Any) -> Callable[[], bool]:
    """A function that performs the step of a `layouts.quick.world.Step`, and returns whether it has.

    While the record has no address of a step, and where there are no builtins, it does nothing.
    """
    definition = _step_definition()
    if definition is None:
        return bool
    address = _Address(ctypes.addressof(record))
    address.kept = record
    return builtin_of(definition, address, "carom")


@cache
def _step_definition() -> MethodDefinition | None:
    from carom.native.host import host

    return None if host is None else defined("take_step", host.symbols.carom_take_step)
