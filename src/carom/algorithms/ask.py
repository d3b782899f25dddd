"""Functions that write a query to memory, run its kernel, and read the answer, at minimum cost.

A call with several unpacked lists, `pack(memory, first, *positions, *rates)`, makes a list and then a tuple
of all items. For a few items it is faster to unpack them into variables and to pass these; for many items it
is faster to write each list by itself. The former needs source code for each number of items, which is
generated at run time, as `namedtuple` does.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, partial
from itertools import accumulate
from struct import Struct
from types import CodeType
from typing import Any

import numpy as np

from carom.native.tables import NUMPY_REAL

Ask = Callable[..., tuple[float, ...]]

_TYPE = np.dtype(NUMPY_REAL)
# Calls with more arguments are slow.
_MAX_ITEMS = 27
_SOURCE = """
def ask(setting, {lists}):
    global seen
    if setting is not seen:
        write_setting(*setting)
        seen = setting
    {writing}
    answer_it()
    result = unpack(answer)
    if result[0] != result[0]:
        raise ValueError("the answer is not finite")
    return result
"""


def asking(
    counts: Sequence[int],
    question: memoryview[float],
    answer_it: Callable[[], None],
    answer: memoryview[float],
    size: int,
) -> Ask:
    """Make a function for queries whose arguments are lists of numbers.

    Args:
        counts: Length of each argument of the function. The first argument is a setting, which counts as
            unchanged as long as it is the same object.
        question: Memory for the arguments, one list after the other.
        answer_it: Computes the answer.
        answer: Memory of the answer.
        size: Length of the answer, at least 1.

    Returns:
        The function. It raises `struct.error` or `ValueError` for a list of another length, `struct.error`
        for items that are not numbers, `TypeError` for arguments that are not lists, and `ValueError` if the
        first number of the answer is NaN.
    """
    memory = question.cast("B")
    setting, *lists = counts
    firsts = [first * _TYPE.itemsize for first in accumulate(counts)]
    names: dict[str, Any] = {
        "seen": None,
        "write_setting": partial(_struct(setting).pack_into, memory, 0),
        "pack": _struct(sum(lists)).pack_into,
        "memory": memory,
        "first": firsts[0],
        "answer_it": answer_it,
        "unpack": _struct(size).unpack_from,
        "answer": answer.cast("B"),
    }
    for number, (first, count) in enumerate(zip(firsts, lists, strict=False)):
        names[f"write_{number}"] = partial(_struct(count).pack_into, memory, first)
    exec(_code(tuple(lists)), names)
    # Its names are not to refer to it.
    return names.pop("ask")


@cache
def _code(counts: tuple[int, ...]) -> CodeType:
    """Compiled code of `ask` for lists of these lengths."""
    lists = [f"list_{number}" for number in range(len(counts))]
    if sum(counts) > _MAX_ITEMS:
        writing = [f"write_{number}(*list_{number})" for number in range(len(counts))]
    else:
        items = [[f"item_{number}_{k}" for k in range(count)] for number, count in enumerate(counts)]
        writing = [f"[{', '.join(own)}] = {given}" for own, given in zip(items, lists, strict=True)]
        writing.append(f"pack(memory, first, {', '.join(name for own in items for name in own)})")
    source = _SOURCE.format(lists=", ".join(lists), writing="; ".join(writing))
    return compile(source, f"<a question of {counts} numbers>", "exec")


def _struct(count: int) -> Struct:
    return Struct(f"{count}{_TYPE.char}")
