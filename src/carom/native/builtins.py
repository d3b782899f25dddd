"""Builtins of CPython made of C code at an address."""

from __future__ import annotations

import ctypes
import sys
from functools import cache
from typing import Any

_METH_FASTCALL, _METH_KEYWORDS = 0x0080, 0x0002


class MethodDefinition(ctypes.Structure):
    """`PyMethodDef` of the C API."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("code", ctypes.c_void_p),
        ("flags", ctypes.c_int),
        ("documentation", ctypes.c_char_p),
    )


# Keeps the definitions in memory: builtins point to them.
_definitions: list[MethodDefinition] = []


def is_usual_python() -> bool:
    """Whether Python has the objects and the lock that C code at an address counts on.

    Other implementations have other objects, and in free-threaded builds threads run in parallel.
    """
    return sys.implementation.name == "cpython" and "free-threading" not in sys.version


def defined(name: str, code: Any, documentation: str = "", *, keywords: bool = False) -> MethodDefinition:
    """The definition of a builtin of the form `f(self, args, nargs)`, or with `keywords` also `kwnames`.

    `code` is the address of its C code, or a function of a loaded library. It is kept for ever.
    """
    address = code if isinstance(code, int) else ctypes.cast(code, ctypes.c_void_p).value
    flags = _METH_FASTCALL | (_METH_KEYWORDS if keywords else 0)
    definition = MethodDefinition(name.encode(), address, flags, documentation.encode())
    _definitions.append(definition)
    return definition


def builtin_of(definition: MethodDefinition, its_self: object, module: str) -> Any:
    """The builtin of a definition, with an object that its code gets as `self`."""
    return _maker()(ctypes.byref(definition), its_self, module)


def descriptor_of(definition: MethodDefinition, kind: type) -> Any:
    """The method of a class that a definition describes; its code gets the object as `self`."""
    make = ctypes.pythonapi.PyDescr_NewMethod
    make.restype, make.argtypes = ctypes.py_object, (ctypes.py_object, ctypes.POINTER(MethodDefinition))
    return make(kind, ctypes.byref(definition))


@cache
def _maker() -> Any:
    make = ctypes.pythonapi.PyCFunction_NewEx
    make.restype = ctypes.py_object
    make.argtypes = (ctypes.POINTER(MethodDefinition), ctypes.py_object, ctypes.py_object)
    return make


def new_builtin(name: str, code: Any, its_self: object) -> Any:
    """A builtin of C code of the form `f(self, args, nargs)`."""
    return builtin_of(defined(name, code), its_self, "carom")
