"""Arrays of C records, by types that are made once.

`ctypes` forgets the type of an array with its last object, and a new type is in reference cycles.
"""

from __future__ import annotations

from collections.abc import Iterable
from ctypes import Array
from functools import lru_cache
from typing import Any

_MOST_TYPES = 1024


@lru_cache(_MOST_TYPES)
def _type(kind: Any, count: int) -> type[Array[Any]]:
    return kind * count


def c_array(kind: type[Any], count: int, items: Iterable[Any] = ()) -> Array[Any]:
    """An array of so many records or numbers of a C type, which begins with `items`; the rest is 0."""
    return _type(kind, count)(*items)
