"""Makes C builtins that call Python functions, because PyBullet's functions are builtins.

`pybullet_utils.bullet_client.BulletClient`, and its many copies in other repositories, add `physicsClientId`
to a call only if `inspect.isbuiltin` is true for the function. It is false for plain Python functions, so
every wrapped call of them would silently go to client 0. Subclasses and `__class__` tricks pass the test too
but cost a second call frame and, with keywords, a dictionary.

CPython makes a builtin from a C function of the form `f(self, args, nargs, kwnames)`. Its own
`PyObject_Vectorcall(callable, args, nargs, kwnames)` has that form, so a builtin whose `self` is a Python
function and whose C code is `PyObject_Vectorcall` calls that function. This adds about 10 ns to a call.

CPython reads the address of the C code at every call, so `quick.py` can replace it.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Callable
from types import CodeType, FunctionType
from typing import Any, NamedTuple, TypeVar

from carom.native.builtins import MethodDefinition, builtin_of, defined

F = TypeVar("F", bound=Callable[..., Any])

# Flags of code objects: CO_VARARGS and CO_VARKEYWORDS.
_TAKES_MORE_BY_PLACE, _TAKES_MORE_BY_NAME = 0x04, 0x08


# Python 3.10 does not export `PyObject_Vectorcall`, but an equivalent for Python functions only.
_VECTORCALL = "PyObject_Vectorcall" if sys.version_info >= (3, 11) else "_PyFunction_Vectorcall"
vectorcall: int = ctypes.cast(getattr(ctypes.pythonapi, _VECTORCALL), ctypes.c_void_p).value or 0
"""Address of the C function that calls a Python function."""

UsualForm = Callable[[tuple[Any, ...], dict[str, Any]], tuple[tuple[Any, ...], dict[str, Any]]]
"""Converts positional and keyword arguments into equivalent ones that fit the signature."""


class Export(NamedTuple):
    """A function of the public interface.

    Attributes:
        function: The Python function.
        builtin: The builtin that calls it.
        usual_form: Converts other forms of the arguments to that of the signature; None if there are none.
        definition: The C API's definition of the builtin.
        code: The function's own code, which `detours.py` may replace for a while.
    """

    function: FunctionType
    builtin: Callable[..., Any]
    usual_form: UsualForm | None
    definition: MethodDefinition
    code: CodeType


exports: dict[str, Export] = {}
"""All functions of the public interface, by name."""


def exported(function: F) -> F:
    """Makes a function of the public interface a builtin of the module `pybullet`."""
    return exported_as(_plain_signature(function))(function)


def exported_requiring(count: int) -> Callable[[F], F]:
    """As `exported`, for a function whose body may also be given as `bodyIndex`.

    So it looks itself whether its first `count` arguments are given. Their defaults are not shown, nor is
    `bodyIndex`.
    """
    return lambda function: exported_as(_plain_signature(function, count))(function)


def exported_as(signature: str, usual_form: UsualForm | None = None) -> Callable[[F], F]:
    """As `exported`, but `help` and `inspect.signature` show the given signature, parentheses included.

    `usual_form` converts other forms of the arguments to that of the signature, if there are any.
    """

    def export(function: F) -> F:
        assert isinstance(function, FunctionType)
        function.__module__ = "pybullet"
        documentation = f"{function.__name__}{signature}\n--\n\n{_documentation(function)}"
        definition = defined(function.__name__, vectorcall, documentation, keywords=True)
        builtin = builtin_of(definition, function, "pybullet")
        exports[function.__name__] = Export(function, builtin, usual_form, definition, function.__code__)
        return builtin

    return export


def _plain_signature(function: Callable[..., Any], required: int = 0) -> str:
    """The signature without annotations, which the text signature of a builtin cannot contain.

    The result is that of `inspect.signature`, in a tenth of the time: there are so many functions that this
    matters for the import of the module. For `required` see `exported_requiring`.
    """
    assert isinstance(function, FunctionType)
    code = function.__code__
    by_place, by_name = code.co_argcount, 0 if required else code.co_kwonlyargcount
    names = code.co_varnames
    shown = list(names[:by_place])
    defaults = function.__defaults__ or ()
    for place, value in enumerate(defaults, by_place - len(defaults)):
        if place >= required:
            shown[place] += f"={value!r}"
    after = by_place + by_name
    if code.co_flags & _TAKES_MORE_BY_PLACE:
        shown.append(f"*{names[after]}")
        after += 1
    elif by_name:
        shown.append("*")
    by_keyword = function.__kwdefaults__ or {}
    for name in names[by_place : by_place + by_name]:
        shown.append(f"{name}={by_keyword[name]!r}" if name in by_keyword else name)
    if code.co_flags & _TAKES_MORE_BY_NAME:
        shown.append(f"**{names[after]}")
    if code.co_posonlyargcount:
        shown.insert(code.co_posonlyargcount, "/")
    return f"({', '.join(shown)})"


def _documentation(function: Callable[..., Any]) -> str:
    """The docstring without its indentation, which Python itself strips from version 3.13 on."""
    text = function.__doc__ or ""
    return (text if sys.version_info >= (3, 13) else text.replace("\n    ", "\n")).strip()
