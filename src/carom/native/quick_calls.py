"""Quick calls: builtins of CPython whose C code is in the native library.

A builtin of `pybullet` stands for a Python function. For some of them the library has C code that handles the
usual case itself, in a fraction of the time, and calls the Python function in all others:
`native/source/quick_calls.cpp` describes how. The library is not linked against Python; this module gives it
the addresses of the few functions that it needs, so that one library serves all versions.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

from carom.layouts.gates import MAX_CLIENTS, Conduct, Guard
from carom.layouts.quick.calls import MAX_CALLS, QuickCall
from carom.native.host import Host, host
from carom.native.uninterrupted import begin, end, is_our_own


class Parameter(NamedTuple):
    """A parameter of a quick call.

    Attributes:
        name: Its name, interned as CPython does with names of parameters.
        kind: A letter: `i` integer, `r` number, `3` and `4` so many numbers, `q` quaternion whose length is
            not zero, `s` list, tuple or range, `v` any number of numbers or None, `b` number of a body, `c`
            of a connection, `-` not used.
        missing: Default for each of its numbers; NaN for None. None if it is required.
    """

    name: str
    kind: str
    missing: float | None


class QuickCalls:
    """The quick calls of this process, in a table of the library, with pointers to what they need of Python.

    Attributes:
        clients: Address of a `Client`, by number; 0 if Python has to handle its calls.
        gates: Address of a `Gate`, by number of the connection; 0 if it is none of this process.
        is_paused: Its value is not 0 while Python has to handle all calls that name a connection.
    """

    def __init__(self, host: Host) -> None:
        symbols = host.symbols
        self.clients: Any = (ctypes.c_void_p * MAX_CLIENTS).from_address(host.clients)
        symbols.carom_gates.restype = ctypes.c_void_p
        self.gates: Any = (ctypes.c_void_p * len(self.clients)).from_address(symbols.carom_gates())
        self.is_paused: ctypes.c_int32 = ctypes.c_int32.in_dll(symbols, "carom_quick_calls_paused")
        self._symbols = symbols
        self._calls = (QuickCall * MAX_CALLS).from_address(host.calls)
        self._guards = (Guard * MAX_CALLS).from_address(host.guards)
        symbols.carom_quick_entry.restype = ctypes.c_void_p
        symbols.carom_meet_host.argtypes = [ctypes.py_object] * 3
        symbols.carom_meet_host(begin, end, is_our_own)
        self._python = host.python
        # Memory that the library points to.
        self._kept: list[Any] = [begin, end, is_our_own]
        self._made = 0

    def guard(self, conduct: Conduct, client_place: int) -> int:
        """The address of the C code of a builtin whose Python function has the world for itself.

        `client_place` is that of the connection among its positional arguments; -1 if it is none of them.
        """
        guard = self._guards[self._made]
        guard.conduct, guard.client_place = conduct, client_place
        self._made += 1
        return self._symbols.carom_quick_entry(self._made - 1)

    def quicken(
        self, kernel: str, parameters: Sequence[Parameter], groups: Sequence[int] | None, *, flat: bool
    ) -> None:
        """Let the builtin that is guarded next try a kernel first.

        The kernel's name is without the prefix `carom_`; parameters are in the order of the Python function.
        `groups` are the lengths of the tuples in the result, 0 for a number in place of a tuple; empty if the
        result is None, and None if the kernel makes the result itself. If `flat`, its group is the result.
        """
        made = self._calls[self._made]
        function = ctypes.cast(self._symbols[f"carom_{kernel}"], ctypes.c_void_p)
        if groups is None:
            made.maker = function
        else:
            made.kernel = function
            made.groups[: len(groups) + 1] = [*groups, -1]
        made.parameter_count = len(parameters)
        for parameter, given in zip(made.parameters, parameters, strict=False):
            self._kept.append(given.name)
            parameter.name = id(given.name)
            parameter.kind = ord(given.kind)
            parameter.is_required = given.missing is None
            parameter.missing = given.missing or 0.0
        made.is_flat = flat

    def meet_numpy(self) -> None:
        """Accept arrays as arguments, too, if NumPy has been imported."""
        numpy = sys.modules.get("numpy")
        for name in ("ndarray", "float64"):
            # None also while another thread is importing it, which calls this as well.
            kind = getattr(numpy, name, None)
            if kind is not None and self._python[name].value != id(kind):
                self._kept.append(kind)
                self._python[name].value = id(kind)


def quick_calls(vectorcall: int) -> QuickCalls | None:
    """The quick calls of this process, for the first caller; None for others, and where there are none.

    The library has one table of them, so a module `pybullet` that is imported a second time goes without.
    `vectorcall` is the address of the function that calls a Python function.
    """
    if host is None or _given_away:
        return None
    _given_away.append(host)
    host.python["PyObject_Vectorcall"].value = vectorcall
    return QuickCalls(host)


_given_away: list[Host] = []
