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


class _RealLiterals(ast.NodeTransformer):
    """Wraps each float literal in a call of `real`."""

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
        code_transformers=[_RealLiterals()],
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


def kernel(function: _F) -> _F:
    """Make `function` a kernel without an adjoint."""
    function.__globals__.setdefault("real", real)
    return wp.Kernel(  # type: ignore[return-value]
        func=function,
        key=function.__qualname__,
        module=wp.get_module(function.__module__),
        options={"enable_backward": False},
        code_transformers=[_RealLiterals()],
    )
