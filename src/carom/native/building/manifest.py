"""Data for calls of kernels: symbols, arguments, and the offsets of the fields of structs.

The layouts are those of C with scalars of four and eight bytes, each at a multiple of its size. All platforms
of Carom have them. Assertions in the generated C++ make a build with other layouts fail.
"""

from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator
from typing import Any

from warp._src.codegen import Struct
from warp._src.types import array_t, is_array, type_ctype

_PYTHON_SCALARS = {bool: "bool", int: "int32", float: "float32"}
_KINDS = {"vec_t": "vector", "mat_t": "matrix", "quat_t": "quaternion", "transform_t": "transform"}
_ARRAY_FIELDS = {
    "data": "uint64",
    "grad": "uint64",
    "shape": "int32[4]",
    "strides": "int32[4]",
    "ndim": "uint16",
    "flags": "uint16",
}
Layout = dict[str, Any]


class LayoutClash(Exception):
    """Two structs of the same name differ."""


def kernel_entry(kernel: Any, module: str) -> Layout:
    """The entry of a kernel, which has been built from a Python module, in the manifest.

    Returns:
        `symbol`, `module`, `dimensions` of its launch, `arguments` (name, type and offset of each, in order),
        and the `size` of all of them in bytes.
    """
    block = _argument_block(kernel)
    return {
        "symbol": f"{kernel.key}_cpu_forward",
        "module": module,
        "dimensions": kernel.adj.kernel_dim,
        "arguments": [
            [argument.label, type_name(argument.type), getattr(block, argument.label).offset]
            for argument in kernel.adj.args
        ],
        "size": ctypes.sizeof(block),
    }


def struct_layouts(kernels: Iterable[Any]) -> dict[str, Layout]:
    """Layouts of all structs that kernels take, and of those in them.

    Returns:
        By name: `fields` (name, type and offset of each, in order), and `size` in bytes.

    Raises:
        LayoutClash: Two different structs have the same name.
    """
    layouts: dict[str, Layout] = {}
    for struct in _structs(kernels):
        fields = {name: type_name(variable.type) for name, variable in struct.vars.items()}
        merge_layouts(layouts, {type_name(struct): _layout(struct.ctype, fields)})
    return layouts


def merge_layouts(into: dict[str, Layout], layouts: dict[str, Layout]) -> None:
    """Add layouts by name to others, in place.

    Raises:
        LayoutClash: Two structs of the same name differ.
    """
    for name, layout in layouts.items():
        if into.setdefault(name, layout) != layout:
            raise LayoutClash(f"there are two structs {name}, and they differ")


def fixed_layouts(dimensions: Iterable[int]) -> dict[str, Layout]:
    """Layouts of structs that Warp itself declares: arrays, and bounds of launches of so many dimensions.

    They are as those of `struct_layouts`, with the names `array`, `bounds(1)` and so on.
    """
    layouts = {"array": _layout(array_t, _ARRAY_FIELDS)}
    for count in sorted(set(dimensions)):
        fields = {"shape": f"uint32[{count}]", "size": "uint64", "coord_mult": "uint64"}
        layouts[f"bounds({count})"] = _layout(_bounds_block(count), fields)
    return layouts


def layout_assertions(kernels: Iterable[Any], lanes: int = 1) -> str:
    """C++ that compiles only if all layouts of a module's kernels are those of the manifest.

    With several `lanes`, structs of numbers have so many in place of each, as in `engine.lane_work`.
    """
    kernels = sorted(kernels, key=lambda kernel: kernel.key)
    lines = []
    for struct in _structs(kernels):
        lines.extend(_assertions(struct.native_name, _widened(struct, lanes)))
    for kernel in kernels:
        lines.extend(_assertions(f"wp_args_{kernel.key}", _argument_block(kernel)))
    lines.extend(_assertions("wp::array_t<double>", array_t))
    for dimensions in sorted({kernel.adj.kernel_dim for kernel in kernels}):
        lines.extend(_assertions(f"wp::launch_bounds_t<{dimensions}>", _bounds_block(dimensions)))
    return "\n".join(["", *lines, ""])


def type_name(kind: Any) -> str:
    """Name of a Warp type in the manifest.

    These are `float64`, `vector(3,float64)`, `matrix(3,3,float64)`, `quaternion(float64)`,
    `transform(float64)`, the module and name of a struct, or `array(ELEMENT,DIMENSIONS)` of any of these.
    """
    if is_array(kind):
        return f"array({type_name(kind.dtype)},{kind.ndim})"
    if isinstance(kind, Struct):
        # Structs of different modules may share a name.
        return f"{kind.cls.__module__}.{kind.key}"
    if kind in _PYTHON_SCALARS:
        return _PYTHON_SCALARS[kind]
    scalar = getattr(kind, "_wp_scalar_type_", None)
    if scalar is None:
        return kind.__name__
    family = next(base.__name__ for base in kind.__mro__ if base.__name__ in _KINDS)
    shape = kind._shape_ if family in ("vec_t", "mat_t") else ()
    return f"{_KINDS[family]}({','.join([*map(str, shape), scalar.__name__])})"


def _structs(kernels: Iterable[Any]) -> list[Any]:
    """Structs that kernels take, and those in them, by name."""
    found: dict[str, Any] = {}

    def visit(kind: Any) -> None:
        if is_array(kind):
            kind = kind.dtype
        if isinstance(kind, Struct) and kind.native_name not in found:
            found[kind.native_name] = kind
            for variable in kind.vars.values():
                visit(variable.type)

    for kernel in kernels:
        for argument in kernel.adj.args:
            visit(argument.type)
    return [found[name] for name in sorted(found)]


def _argument_block(kernel: Any) -> type[ctypes.Structure]:
    fields = [(argument.label, _ctype(argument.type)) for argument in kernel.adj.args]
    return type("ArgumentBlock", (ctypes.Structure,), {"_fields_": fields})


def _bounds_block(dimensions: int) -> type[ctypes.Structure]:
    fields = [
        ("shape", ctypes.c_uint32 * dimensions),
        ("size", ctypes.c_uint64),
        ("coord_mult", ctypes.c_uint64),
    ]
    return type("BoundsBlock", (ctypes.Structure,), {"_fields_": fields})


def _ctype(kind: Any) -> Any:
    if is_array(kind):
        return array_t
    return kind.ctype if isinstance(kind, Struct) else type_ctype(kind)


def _widened(struct: Any, lanes: int) -> Any:
    """The C struct with so many numbers in place of each; that of trees has none that lanes read."""
    if lanes == 1 or struct.key == "TreeModel":
        return struct.ctype
    kinds = {name: type_name(variable.type) for name, variable in struct.vars.items()}
    fields = [
        (name, c_type * lanes if "float64" in kinds[name] and not kinds[name].startswith("array") else c_type)
        for name, c_type in struct.ctype._fields_
    ]
    return type("Wide", (ctypes.Structure,), {"_fields_": fields})


def _layout(block: Any, fields: dict[str, str]) -> Layout:
    return {
        "fields": [[name, kind, getattr(block, name).offset] for name, kind in fields.items()],
        "size": ctypes.sizeof(block),
    }


def _assertions(name: str, block: Any) -> Iterator[str]:
    yield f'static_assert(sizeof({name}) == {ctypes.sizeof(block)}, "size of {name}");'
    for field, *_ in block._fields_:
        offset = getattr(block, field).offset
        yield f'static_assert(__builtin_offsetof({name}, {field}) == {offset}, "place of {name}.{field}");'
