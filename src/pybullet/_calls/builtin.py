"""Python functions that are C builtins, as PyBullet's are.

`pybullet_utils.bullet_client.BulletClient`, and the many copies of it in other people's repositories,
add `physicsClientId` to a call only when `inspect.isbuiltin` says that the function is a builtin. Plain
Python functions are not, so with them every wrapped call would silently go to client 0. Subclasses and
`__class__` tricks pass the test too but cost a second call frame and, with keywords, a dictionary.

CPython makes a builtin from a C function of the form `f(self, args, nargs, kwnames)`. Its own
`PyObject_Vectorcall(callable, args, nargs, kwnames)` has that form, so a builtin whose `self` is a Python
function and whose C code is `PyObject_Vectorcall` calls that function: a real builtin for about 10 ns.
"""

from __future__ import annotations

import ctypes
import inspect
import sys
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

F = TypeVar("F", bound=Callable[..., Any])

_METH_FASTCALL_WITH_KEYWORDS = 0x0080 | 0x0002


class _MethodDefinition(ctypes.Structure):
    """`PyMethodDef` of the C API."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("code", ctypes.c_void_p),
        ("flags", ctypes.c_int),
        ("documentation", ctypes.c_char_p),
    )


_new_builtin = ctypes.pythonapi.PyCFunction_NewEx
_new_builtin.restype = ctypes.py_object
_new_builtin.argtypes = (ctypes.POINTER(_MethodDefinition), ctypes.py_object, ctypes.py_object)
# Python 3.10 does not export that one, but the same for Python functions alone.
_VECTORCALL = "PyObject_Vectorcall" if sys.version_info >= (3, 11) else "_PyFunction_Vectorcall"
_vectorcall = ctypes.cast(getattr(ctypes.pythonapi, _VECTORCALL), ctypes.c_void_p).value

UsualForm = Callable[[tuple[Any, ...], dict[str, Any]], tuple[tuple[Any, ...], dict[str, Any]]]
"""Turns arguments by position and by name into others that mean the same and fit the signature."""


class Export(NamedTuple):
    """A function of the public interface.

    Attributes:
        function: The Python function.
        builtin: The builtin that calls it.
        usual_form: For a function that is also called in other ways than its signature shows.
    """

    function: Callable[..., Any]
    builtin: Callable[..., Any]
    usual_form: UsualForm | None


exports: dict[str, Export] = {}
"""All functions of the public interface, by name."""

# A builtin points to its definition for as long as it lives, and builtins of a module live for ever.
_definitions: list[_MethodDefinition] = []


def exported(function: F) -> F:
    """Makes a function of the public interface a builtin of the module `pybullet`."""
    return exported_as(_plain_signature(function))(function)


def exported_as(signature: str, usual_form: UsualForm | None = None) -> Callable[[F], F]:
    """As `exported`, for a function whose Python signature is not the one to show.

    Args:
        signature: What `help` and `inspect.signature` show, parentheses included.
        usual_form: For a function that is also called in other ways.
    """

    def export(function: F) -> F:
        function.__module__ = "pybullet"
        documentation = f"{function.__name__}{signature}\n--\n\n{inspect.getdoc(function) or ''}"
        definition = _MethodDefinition(
            function.__name__.encode(),
            _vectorcall,
            _METH_FASTCALL_WITH_KEYWORDS,
            documentation.encode(),
        )
        _definitions.append(definition)
        builtin = _new_builtin(ctypes.byref(definition), function, "pybullet")
        exports[function.__name__] = Export(function, builtin, usual_form)
        return builtin

    return export


def _plain_signature(function: Callable[..., Any]) -> str:
    """The signature without annotations: what the text signature of a builtin may hold."""
    signature = inspect.signature(function)
    bare = [p.replace(annotation=inspect.Parameter.empty) for p in signature.parameters.values()]
    return str(signature.replace(parameters=bare, return_annotation=inspect.Signature.empty))
