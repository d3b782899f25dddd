"""Where two answers differ: nested lists, dictionaries, numbers and names, ours and PyBullet's."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any


def differences(
    ours: Any, theirs: Any, where: str = "", is_close: Callable[[float, float, str], bool] | None = None
) -> list[str]:
    """Every place where two answers differ by more than rounding.

    Args:
        ours: Carom's.
        theirs: PyBullet's.
        where: The place of these two in the whole.
        is_close: Whether two numbers at a place count as the same; without one, 1e-9 of them do, or 1e-12.
    """
    if isinstance(ours, dict) and isinstance(theirs, dict) and ours.keys() == theirs.keys():
        pairs = [(ours[key], theirs[key], f"{where}.{key}") for key in ours]
    elif isinstance(ours, list) and isinstance(theirs, list) and len(ours) == len(theirs):
        pairs = [(a, b, f"{where}[{i}]") for i, (a, b) in enumerate(zip(ours, theirs, strict=True))]
    else:
        return (
            [] if _is_same(ours, theirs, where, is_close) else [f"{where}: {ours!r}, PyBullet has {theirs!r}"]
        )
    return [line for a, b, at in pairs for line in differences(a, b, at, is_close)]


def _is_same(
    ours: Any, theirs: Any, where: str, is_close: Callable[[float, float, str], bool] | None
) -> bool:
    if ours == theirs:
        return True
    if not (isinstance(ours, (int, float)) and isinstance(theirs, (int, float))):
        return False
    if is_close is not None:
        return is_close(ours, theirs, where)
    return math.isclose(ours, theirs, rel_tol=1e-9, abs_tol=1e-12)
