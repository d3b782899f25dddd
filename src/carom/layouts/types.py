"""Types shared by kernels and Python: numbers, vectors, arrays and structs.

A struct is declared once, as a class with annotations, which `struct` makes a C struct (`ctypes.Structure`).
The NumPy types of tables (`carom.native.tables`) and Warp's structs (`carom.kernels.structs`) are derived
from its `fields`.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from carom.record import record

_SCALARS: dict[str, Any] = {
    "int32": ctypes.c_int32,
    "uint32": ctypes.c_uint32,
    "uint8": ctypes.c_uint8,
    "float32": ctypes.c_float,
    "float64": ctypes.c_double,
}


@record
class Type:
    """Type of a scalar, or of a vector or matrix of fixed size.

    Attributes:
        scalar: NumPy's name of the type of the numbers.
        shape: Its shape; () for a scalar.
        kind: Its type in kernels: "scalar", "vector", "quaternion", "transform" or "matrix".
    """

    scalar: str
    shape: tuple[int, ...] = ()
    kind: str = "scalar"

    @property
    def c_type(self) -> Any:
        """The type in C: a number or an array."""
        c_type = _SCALARS[self.scalar]
        for length in reversed(self.shape):
            c_type = c_type * length
        return c_type


@record
class ArrayType:
    """Type of an array of one or two dimensions; the first of two is the world axis.

    Attributes:
        entry: Type of an entry: a `Type` or a struct.
        ndim: Number of dimensions.
    """

    entry: Any
    ndim: int = 1

    @property
    def c_type(self) -> Any:
        """The type in C."""
        return ArrayView


class ArrayView(ctypes.Structure):
    """Array argument of a kernel: its address, and its shape and strides [bytes] on up to four axes."""

    _fields_: ClassVar[Any] = [
        ("data", ctypes.c_uint64),
        ("gradient", ctypes.c_uint64),  # unused
        ("shape", ctypes.c_int32 * 4),
        ("strides", ctypes.c_int32 * 4),
        ("ndim", ctypes.c_uint16),
        ("flags", ctypes.c_uint16),  # unused
    ]


class Struct(ctypes.Structure):
    """Base of all structs.

    Attributes:
        fields: Types of the fields by name: `Type`, `ArrayType` or another struct.
    """

    fields: ClassVar[Mapping[str, Any]]


def c_type(declared: Any) -> Any:
    """The type in C of a declared type."""
    return declared if isinstance(declared, type) else declared.c_type


def struct(declaration: type) -> Any:
    """Make a C struct from a class with annotations, its fields."""
    fields: dict[str, Any] = declaration.__annotations__
    return type(
        declaration.__name__,
        (Struct,),
        {
            "__module__": declaration.__module__,
            "__doc__": declaration.__doc__,
            "fields": fields,
            "_fields_": [(name, c_type(field)) for name, field in fields.items()],
        },
    )


if TYPE_CHECKING:
    # The type checker does not know the types of fields.
    real = Any
    Float32 = Any
    Int32 = Any
    UInt32 = Any
    Index2 = Any
    Index3 = Any
    Index4 = Any
    Colour = Any
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
else:
    real = Type("float64")
    Float32 = Type("float32")
    Int32 = Type("int32")
    UInt32 = Type("uint32")
    Index2 = Type("int32", (2,), "vector")
    Index3 = Type("int32", (3,), "vector")
    Index4 = Type("int32", (4,), "vector")
    Colour = Type("uint8", (3,), "vector")
    Vector2 = Type("float64", (2,), "vector")
    Vector3 = Type("float64", (3,), "vector")
    Vector4 = Type("float64", (4,), "vector")
    Vector6 = Type("float64", (6,), "vector")
    Vector8 = Type("float64", (8,), "vector")
    Quaternion = Type("float64", (4,), "quaternion")
    Matrix3 = Type("float64", (3, 3), "matrix")
    Matrix4 = Type("float64", (4, 4), "matrix")
    Matrix43 = Type("float64", (4, 3), "matrix")
    Matrix8 = Type("float64", (8, 8), "matrix")
    Matrix48 = Type("float64", (4, 8), "matrix")
    Matrix84 = Type("float64", (8, 4), "matrix")
    Transform = Type("float64", (7,), "transform")

if TYPE_CHECKING:
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
    # One entry per tree, link, coordinate...: shared by all worlds.
    Ints = ArrayType(Int32)
    Reals = ArrayType(real)
    Vectors3 = ArrayType(Vector3)
    Vectors4 = ArrayType(Vector4)
    Quaternions = ArrayType(Quaternion)
    Transforms = ArrayType(Transform)

    # The same with a leading world axis.
    IntRows = ArrayType(Int32, 2)
    Index4Rows = ArrayType(Index4, 2)
    RealRows = ArrayType(real, 2)
    Vector3Rows = ArrayType(Vector3, 2)
    Vector4Rows = ArrayType(Vector4, 2)
    Vector6Rows = ArrayType(Vector6, 2)
    Vector8Rows = ArrayType(Vector8, 2)
    QuaternionRows = ArrayType(Quaternion, 2)
    Matrix3Rows = ArrayType(Matrix3, 2)
    TransformRows = ArrayType(Transform, 2)
