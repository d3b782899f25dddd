"""Objects that connect in `__init__` and disconnect in `__del__`, as the copies of `BulletClient` do.

One in a reference cycle is finalized when Python collects garbage, perhaps long after its connection has
ended. Its id may belong to another connection by then, which must not end with it.
"""

from __future__ import annotations

from contextlib import suppress
from types import FrameType
from typing import Any
from weakref import ref

# By the `id` of an object, its class and the connection that it has made. These are no weak references to the
# objects, because such are cleared before a finalizer is called.
_made: dict[int, tuple[str, ref[Any]]] = {}


def note_maker(frame: FrameType, client: Any) -> None:
    """Note who has made a connection, if the frame is that of `__init__` of a class with a finalizer."""
    maker = _first_argument(frame) if frame.f_code.co_name == "__init__" else None
    if hasattr(type(maker), "__del__"):
        with suppress(TypeError):
            _made[id(maker)] = type(maker).__qualname__, ref(client)


def is_of_another_connection(frame: FrameType | None, client: Any) -> bool:
    """Whether a finalizer calls whose object has made another connection than the present one of its id."""
    while frame is not None and frame.f_code.co_name != "__del__":
        frame = frame.f_back
    if frame is None:
        return False
    finalized = _first_argument(frame)
    kind, made = _made.pop(id(finalized), ("", None))
    return made is not None and kind == type(finalized).__qualname__ and made() is not client


def _first_argument(frame: FrameType) -> object | None:
    names = frame.f_code.co_varnames
    return frame.f_locals.get(names[0]) if names else None
