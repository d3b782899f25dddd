"""Masks of worlds, and the names of joints and links."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Mask = NDArray[np.bool_]


def choose(what: str, names: Sequence[str], key: int | str) -> int:
    """The index of the joint or link with an index (or `IndexError`) or a name (or `KeyError`)."""
    if isinstance(key, str):
        if key not in names:
            raise KeyError(f"no {what} is called {key!r}; there are {', '.join(names)}")
        return names.index(key)
    if not 0 <= key < len(names):
        raise IndexError(f"{what} {key} is out of range: indices are 0 to {len(names) - 1}")
    return key
