"""The number type of the engine, and the decorators that let kernels read as plain maths.

`real` is float64; `CAROM_PRECISION=float32`, set before the first import, makes it float32, which
is what most GPUs are fast at. Warp reads a bare `0.5` in a kernel as float32, so `func` and
`kernel` wrap every float literal as `real(0.5)` before Warp sees it, and put `real` in reach.
"""

from __future__ import annotations

import ast
import functools
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

if TYPE_CHECKING:
    # Kernel code is checked by Warp, not by the Python type checker.
    real = Any
    Int32 = Any
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
    Index4 = Any
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

import warp as wp

from carom.model.warp_start import start_warp

start_warp()

_PRECISIONS = {"float32": (wp.float32, np.float32), "float64": (wp.float64, np.float64)}
PRECISION = os.environ.get("CAROM_PRECISION", "float64")
if PRECISION not in _PRECISIONS:
    raise ImportError(f"CAROM_PRECISION is {PRECISION!r}; expected one of {sorted(_PRECISIONS)}")

if not TYPE_CHECKING:
    real, _ = _PRECISIONS[PRECISION]
    Int32 = wp.int32
    Index4 = wp.types.vector(4, wp.int32)
    Vector3 = wp.types.vector(3, real)
    Vector4 = wp.types.vector(4, real)
    Vector6 = wp.types.vector(6, real)
    Vector8 = wp.types.vector(8, real)
    Quaternion = wp.types.quaternion(real)
    Matrix3 = wp.types.matrix((3, 3), real)
    Matrix4 = wp.types.matrix((4, 4), real)
    Matrix43 = wp.types.matrix((4, 3), real)
    Matrix8 = wp.types.matrix((8, 8), real)
    Matrix48 = wp.types.matrix((4, 8), real)
    Matrix84 = wp.types.matrix((8, 4), real)
    Transform = wp.types.transformation(real)

    # One value per tree, link, coordinate...: shared by all worlds.
    Ints = wp.array(dtype=Int32)
    Reals = wp.array(dtype=real)
    Vectors3 = wp.array(dtype=Vector3)
    Vectors4 = wp.array(dtype=Vector4)
    Quaternions = wp.array(dtype=Quaternion)
    Transforms = wp.array(dtype=Transform)

    # The same with a leading world axis.
    IntRows = wp.array2d(dtype=Int32)
    Index4Rows = wp.array2d(dtype=Index4)
    RealRows = wp.array2d(dtype=real)
    Vector3Rows = wp.array2d(dtype=Vector3)
    Vector4Rows = wp.array2d(dtype=Vector4)
    Vector6Rows = wp.array2d(dtype=Vector6)
    Vector8Rows = wp.array2d(dtype=Vector8)
    QuaternionRows = wp.array2d(dtype=Quaternion)
    Matrix3Rows = wp.array2d(dtype=Matrix3)
    TransformRows = wp.array2d(dtype=Transform)

NUMPY_REAL: type[np.floating[Any]] = _PRECISIONS[PRECISION][1]


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

    Warp passes structs by value; only inlined calls spare copying all their arrays.
    """
    return _warp_function(function, "forceinline")


def shared_func(function: _F) -> _F:
    """Make `function` callable from kernels, compiled once and called.

    For long functions with several callers, which inlining would multiply. Their arguments should be
    numbers, vectors and a few arrays: see `func`.
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


def fuse_multiply_add(module: str) -> None:
    """Let the kernels of a module round a product and the sum it goes into once, which is quicker.

    Args:
        module: Name of the Python module they are in.
    """
    flags = f"{wp.config.cpu_compiler_flags or '-march=native'} -ffp-contract=fast"
    wp.get_module(module).options["cpu_compiler_flags"] = flags
