"""Conversion of declared types and structs to Warp's."""

from __future__ import annotations

from functools import cache
from typing import Any

import warp as wp

from carom.layouts.types import ArrayType, Type

_SCALARS: dict[str, Any] = {
    "int32": wp.int32,
    "uint32": wp.uint32,
    "uint8": wp.uint8,
    "float32": wp.float32,
    "float64": wp.float64,
}


@cache
def warp_type(declared: Any) -> Any:
    """Warp's type for a type, array or struct that is declared in `carom.layouts`."""
    if isinstance(declared, ArrayType):
        return wp.array(dtype=warp_type(declared.entry), ndim=declared.ndim)
    if isinstance(declared, Type):
        scalar = _SCALARS[declared.scalar]
        if declared.kind == "vector":
            return wp.types.vector(declared.shape[0], scalar)
        if declared.kind == "matrix":
            return wp.types.matrix(declared.shape, scalar)
        return {
            "scalar": scalar,
            "quaternion": wp.types.quaternion(scalar),
            "transform": wp.types.transformation(scalar),
        }[declared.kind]
    return _warp_struct(declared)


def _warp_struct(declared: Any) -> Any:
    annotations = {name: warp_type(field) for name, field in declared.fields.items()}
    body = {"__annotations__": annotations, "__module__": __name__, "__doc__": declared.__doc__}
    return wp.struct(type(declared.__name__, (), body))
