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
    # Kernel code is checked by Warp, not by the Python type checker.
    real = Any
    Int32 = Any
    Index4 = Any
    Vector2 = Any
    Vector3 = Any
    Vector4 = Any
    Vector6 = Any
    Vector8 = Any
    Quaternion = Any
    Matrix3 = Any
    Matrix4 = Any
    Matrix43 = Any
    Matrix8 = Any
    Matrix48 = Any
    Matrix84 = Any
    Transform = Any
    Ints = Any
    Reals = Any
    Vectors3 = Any
    Vectors4 = Any
    Quaternions = Any
    Transforms = Any
    IntRows = Any
    Index4Rows = Any
    RealRows = Any
    Vector3Rows = Any
    Vector4Rows = Any
    Vector6Rows = Any
    Vector8Rows = Any
    QuaternionRows = Any
    Matrix3Rows = Any
    TransformRows = Any
else:
    real = warp_type(types.real)
    Int32 = warp_type(types.Int32)
    Index4 = warp_type(types.Index4)
    Vector2 = warp_type(types.Vector2)
    Vector3 = warp_type(types.Vector3)
    Vector4 = warp_type(types.Vector4)
    Vector6 = warp_type(types.Vector6)
    Vector8 = warp_type(types.Vector8)
    Quaternion = warp_type(types.Quaternion)
    Matrix3 = warp_type(types.Matrix3)
    Matrix4 = warp_type(types.Matrix4)
    Matrix43 = warp_type(types.Matrix43)
    Matrix8 = warp_type(types.Matrix8)
    Matrix48 = warp_type(types.Matrix48)
    Matrix84 = warp_type(types.Matrix84)
    Transform = warp_type(types.Transform)
    Ints = warp_type(types.Ints)
    Reals = warp_type(types.Reals)
    Vectors3 = warp_type(types.Vectors3)
    Vectors4 = warp_type(types.Vectors4)
    Quaternions = warp_type(types.Quaternions)
    Transforms = warp_type(types.Transforms)
    IntRows = warp_type(types.IntRows)
    Index4Rows = warp_type(types.Index4Rows)
    RealRows = warp_type(types.RealRows)
    Vector3Rows = warp_type(types.Vector3Rows)
    Vector4Rows = warp_type(types.Vector4Rows)
    Vector6Rows = warp_type(types.Vector6Rows)
    Vector8Rows = warp_type(types.Vector8Rows)
    QuaternionRows = warp_type(types.QuaternionRows)
    Matrix3Rows = warp_type(types.Matrix3Rows)
    TransformRows = warp_type(types.TransformRows)


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
