"""The types of `carom.layouts` as Warp types, and the decorators for device functions and kernels.

Only device code imports this module, because it imports Warp. `real` is float64. Warp compiles a bare `0.5`
as float32. So the decorators wrap every float literal as `real(0.5)` before Warp sees it, and add `real` to
the globals of the function.
"""

from __future__ import annotations

import ast
import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import warp as wp

from carom.kernels.warp_start import start_warp
from carom.kernels.warp_types import warp_type
from carom.layouts import types

start_warp()

if TYPE_CHECKING:
    real = Any

    def __getattr__(name: str) -> Any:
        """Kernel code is checked by Warp, not by the Python type checker."""

else:
    for name, declared in vars(types).items():
        if isinstance(declared, types.Type | types.ArrayType):
            globals()[name] = warp_type(declared)


class _Reals(ast.NodeTransformer):
    """Wraps each float literal in a call of `real`, and gives each `real(NAME)` of a constant its own name.

    Warp turns the constant in `real(NAME)` into a variable, which other uses of that name in the function
    then read, whether it has been assigned or not, and whatever it is by then.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._globals = function.__globals__
        self._locals = function.__code__.co_varnames
        self._count = 0

    def visit_Call(self, node: ast.Call) -> ast.AST:
        match node:
            case ast.Call(func=ast.Name(id="real"), args=[ast.Name(id=name) as constant]):
                value = self._globals.get(name)
                if name not in self._locals and isinstance(value, int | float | real):
                    self._count += 1
                    constant.id = f"{name}_{self._count}_as_real"
                    self._globals[constant.id] = value
        return self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        if not isinstance(node.value, float):
            return node
        call = ast.Call(func=ast.Name(id="real", ctx=ast.Load()), args=[node], keywords=[])
        return ast.fix_missing_locations(ast.copy_location(call, node))


_F = TypeVar("_F", bound=Callable[..., Any])


def _warp_function(function: _F, inline_hint: Literal["forceinline", "noinline"]) -> _F:
    function.__globals__.setdefault("real", real)
    module = wp.get_module(function.__module__)
    key = function.__qualname__
    wp.Function(
        func=function,
        key=key,
        namespace="",
        module=module,
        doc=function.__doc__ or "",
        code_transformers=[_Reals(function)],
        scope_locals={},
        inline_hint=inline_hint,
    )
    return functools.update_wrapper(module.functions[key], function)  # type: ignore[return-value]


def func(function: _F) -> _F:
    """Make `function` callable from kernels, inlined wherever it is called.

    Warp passes structs by value, with all their array descriptors; inlining avoids these copies.
    """
    return _warp_function(function, "forceinline")


def shared_func(function: _F) -> _F:
    """Make `function` callable from kernels, compiled once and not inlined.

    For long functions with several callers, whose code inlining would duplicate. Their arguments should be
    numbers, vectors and a few arrays, since arguments are copied: see `func`.
    """
    return _warp_function(function, "noinline")


def called_func(function: _F) -> _F:
    """Make `function` callable from kernels; on CPUs it is called, and inlined on GPUs only.

    For the longest functions, so that compilers need not optimize whole stages at once, where a call costs
    next to nothing: those performed once for a world, an island or a soft body, or seldom. Others, as
    those for each pair of shapes, tree or contact, are inlined. See `native.building.inlining`.
    """
    function.called = True  # type: ignore[attr-defined]
    return func(function)


def kernel(function: _F) -> _F:
    """Make `function` a kernel without an adjoint."""
    function.__globals__.setdefault("real", real)
    return wp.Kernel(  # type: ignore[return-value]
        func=function,
        key=function.__qualname__,
        module=wp.get_module(function.__module__),
        options={"enable_backward": False},
        code_transformers=[_Reals(function)],
    )
