"""What the native library knows of Python: addresses of its functions, in a table of the library.

The library is not linked against Python, so that one library serves all versions. Builds of CPython other
than the usual one, and interpreters of the process other than the first, have no such table.
"""

from __future__ import annotations

import builtins
import ctypes
import sys
from typing import Any, NamedTuple

from carom.native.builtins import is_usual_python
from carom.native.handlers import meet_library
from carom.native.library import library


class Host(NamedTuple):
    """The table, and those of quick calls.

    Attributes:
        symbols: The library.
        python: Pointers to functions and objects of Python, by name.
        calls: Address of the table of `QuickCall`.
        guards: Address of the table of `Guard`.
        clients: Address of the table of clients.
    """

    symbols: Any
    python: dict[str, ctypes.c_void_p]
    calls: int
    guards: int
    clients: int


# It is not exported by Python 3.10; `carom.native.quick_calls` knows another one.
_VECTORCALL = "PyObject_Vectorcall"


def _met() -> Host | None:
    # In debug builds the header of objects differs.
    if not is_usual_python() or hasattr(sys, "getobjects"):
        return None
    symbols: ctypes.CDLL | None = library().symbols
    if symbols is None:
        # The library is in another process; see `tools.wheels.elsewhere`.
        return None
    python, calls, guards, clients = (ctypes.c_void_p() for _ in range(4))
    if not symbols.carom_claim_quick_calls(*map(ctypes.byref, (python, calls, guards, clients))):
        return None
    functions, objects = (
        ctypes.string_at(_address(symbols, f"carom_python_{kind}")).decode().split()
        for kind in ("functions", "objects")
    )
    size = ctypes.sizeof(ctypes.c_void_p)
    places = {
        name: ctypes.c_void_p.from_address((python.value or 0) + place * size)
        for place, name in enumerate((*functions, *objects))
    }
    for name in functions:
        if name != _VECTORCALL:
            places[name].value = _address(ctypes.pythonapi, name)
    for name in objects:
        if hasattr(builtins, name):
            places[name].value = id(getattr(builtins, name))
    meet_library(symbols)
    return Host(symbols, places, calls.value or 0, guards.value or 0, clients.value or 0)


def _address(symbols: Any, name: str) -> int:
    return ctypes.addressof(ctypes.c_char.in_dll(symbols, name))


# Made as the module is imported, which other threads wait for.
host: Host | None = _met()
"""None if the library cannot use Python here."""
