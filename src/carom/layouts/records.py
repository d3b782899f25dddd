"""Records that Python shares with the library's hand-written C++.

A record is declared once, as a class with annotations, its fields, which `c_record` makes a C struct
(`ctypes.Structure`). The build writes the C++ structs from the same declarations, with assertions that sizes
and places of fields agree (`carom.native.building.headers`).
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple


class CType(NamedTuple):
    """Type of a field.

    Attributes:
        name: Its name in C++, that of the entries for an array.
        c_type: The same for `ctypes`.
        lengths: Lengths of an array along its axes.
    """

    name: str
    c_type: Any
    lengths: tuple[int, ...] = ()


class Record(ctypes.Structure):
    """Base of all records.

    Attributes:
        fields: Types of the fields by name: `CType` or another record.
    """

    fields: ClassVar[Mapping[str, Any]]


def c_record(**lengths: int | tuple[int, ...]) -> Callable[[type], Any]:
    """Make a record from a class with annotations, its fields; those with lengths are arrays of that."""

    def made(declaration: type) -> Any:
        fields = {
            name: _array(kind, lengths[name]) if name in lengths else kind
            for name, kind in declaration.__annotations__.items()
        }
        return type(
            declaration.__name__,
            (Record,),
            {
                "__module__": declaration.__module__,
                "__doc__": declaration.__doc__,
                "fields": fields,
                "_fields_": [(name, _typed(field).c_type) for name, field in fields.items()],
            },
        )

    return made


def _typed(declared: Any) -> CType:
    return declared if isinstance(declared, CType) else CType(declared.__name__, declared)


def _array(kind: Any, lengths: int | tuple[int, ...]) -> CType:
    entry = _typed(kind)
    lengths = lengths if isinstance(lengths, tuple) else (lengths,)
    c_type = entry.c_type
    for length in reversed(lengths):
        c_type = c_type * length
    return CType(entry.name, c_type, lengths)


def _address(name: str) -> CType:
    return CType(name, ctypes.c_void_p)


if TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """The type checker does not know the types of fields; so they may stand in annotations."""

else:
    Int32 = CType("int32_t", ctypes.c_int32)
    Int64 = CType("int64_t", ctypes.c_int64)
    UInt64 = CType("uint64_t", ctypes.c_uint64)
    Double = CType("double", ctypes.c_double)
    Bytes = _address("char*")
    Anything = _address("void*")
    Object = _address("PyObject*")
    # Functions, see `native/source/functions.h`.
    KernelFunction, Kernel, Maker = map(_address, ("KernelFunction", "Kernel", "Maker"))

    class At:
        """`At[X]` is the address of an X, or of the first of several."""

        def __class_getitem__(cls, pointed: Any) -> CType:
            return _address(f"{_typed(pointed).name}*")

    class Read:
        """`Read[X]` is the same where C++ only reads."""

        def __class_getitem__(cls, pointed: Any) -> CType:
            return _address(f"const {_typed(pointed).name}*")
