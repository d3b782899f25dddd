"""Types shared by kernels and Python: numbers, vectors, arrays and structs.

A struct is declared once, as a class with annotations, which `struct` makes a C struct (`ctypes.Structure`).
The NumPy types of tables (`carom.native.tables`) and Warp's structs (`carom.kernels.structs`) are derived
from its `fields`.
"""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

_SCALARS: dict[str, Any] = {
    "int32": ctypes.c_int32,
    "uint32": ctypes.c_uint32,
    "uint8": ctypes.c_uint8,
    "float32": ctypes.c_float,
    "float64": ctypes.c_double,
}


class Type(NamedTuple):
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


class ArrayType(NamedTuple):
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
        uses: What each of them is for, likewise.
    """

    fields: ClassVar[Mapping[str, Any]]
    uses: ClassVar[Mapping[str, Use]]


def c_type(declared: Any) -> Any:
    """The type in C of a declared type."""
    return declared if isinstance(declared, type) else declared.c_type


STATE, PARAMETER, CACHE = "state", "parameter", "cache"


class Use(NamedTuple):
    """What an array of a world is for, and the rows that it has.

    Attributes:
        kind: `STATE`: a step starts from it, and snapshots and files have it. `PARAMETER`: it says what the
            world is, and changes by setters only. `CACHE`: steps find it out anew.
        axis: What it has a row for: a link, a dof, a contact.
        joints: The rows of bases are unused, and are not saved.
        bounded: Its numbers are at most `MAX_MAGNITUDE`; of others some are infinite.
        may_be_nan: It is a report of the last step, which is NaN where nothing could move.
    """

    kind: str
    axis: str
    joints: bool = False
    bounded: bool = False
    may_be_nan: bool = False


def state(axis: str, *, joints: bool = False, bounded: bool = False, may_be_nan: bool = False) -> Any:
    """Declare that a field is state, see `Use`."""
    return Use(STATE, axis, joints, bounded, may_be_nan)


def parameter(axis: str) -> Any:
    """Declare that a field is a parameter."""
    return Use(PARAMETER, axis)


def cache(axis: str) -> Any:
    """Declare that a field is found out anew by each step."""
    return Use(CACHE, axis)


def struct(declaration: type) -> Any:
    """Make a C struct from a class with annotations, its fields.

    Those of a world say what they are for: `state`, `parameter` or `cache`. All others are working memory,
    where the first word of a name, up to an underscore, is the axis; a name has a meaning nowhere else.

    Raises:
        TypeError: Some fields say what they are for, and others do not.
    """
    fields: dict[str, Any] = declaration.__annotations__
    stated = {name: use for name, use in vars(declaration).items() if isinstance(use, Use)}
    if stated and stated.keys() != fields.keys():
        (missing, *_) = fields.keys() - stated.keys()
        raise TypeError(f"{declaration.__name__}.{missing}: say whether it is state, parameter or cache")
    uses = stated or {name: Use(CACHE, name.partition("_")[0]) for name in fields}
    return type(
        declaration.__name__,
        (Struct,),
        {
            "__module__": declaration.__module__,
            "__doc__": declaration.__doc__,
            "fields": fields,
            "uses": uses,
            "_fields_": [(name, c_type(field)) for name, field in fields.items()],
        },
    )


if TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """The type checker does not know the types of fields."""

else:
    real = Type("float64")
    Float32 = Type("float32")
    Int32 = Type("int32")
    UInt32 = Type("uint32")
    Truth = Type("uint8")  # 0 or 1, NumPy's booleans
    Index2 = Type("int32", (2,), "vector")
    Index3 = Type("int32", (3,), "vector")
    Index4 = Type("int32", (4,), "vector")
    Colour = Type("uint8", (3,), "vector")
    Vector2 = Type("float64", (2,), "vector")
    Vector3 = Type("float64", (3,), "vector")
    Vector4 = Type("float64", (4,), "vector")
    Vector6 = Type("float64", (6,), "vector")
    Vector8 = Type("float64", (8,), "vector")
    Vector12 = Type("float64", (12,), "vector")
    Quaternion = Type("float64", (4,), "quaternion")
    Matrix3 = Type("float64", (3, 3), "matrix")
    Matrix4 = Type("float64", (4, 4), "matrix")
    Matrix43 = Type("float64", (4, 3), "matrix")
    Matrix8 = Type("float64", (8, 8), "matrix")
    Matrix48 = Type("float64", (4, 8), "matrix")
    Matrix84 = Type("float64", (8, 4), "matrix")
    Transform = Type("float64", (7,), "transform")

    class Array:
        """`Array[X]` has one X per tree, link, coordinate...: shared by all worlds."""

        def __class_getitem__(cls, entry: Any) -> ArrayType:
            return ArrayType(entry)

    class Rows:
        """`Rows[X]` has a leading world axis in addition."""

        def __class_getitem__(cls, entry: Any) -> ArrayType:
            return ArrayType(entry, 2)

    Ints = Array[Int32]
    Reals = Array[real]
    Vectors3 = Array[Vector3]
    Vectors4 = Array[Vector4]
    Quaternions = Array[Quaternion]
    Transforms = Array[Transform]

    IntRows = Rows[Int32]
    Index2Rows = Rows[Index2]
    Index4Rows = Rows[Index4]
    RealRows = Rows[real]
    Vector3Rows = Rows[Vector3]
    Vector4Rows = Rows[Vector4]
    Vector6Rows = Rows[Vector6]
    Vector8Rows = Rows[Vector8]
    Matrix3Rows = Rows[Matrix3]
    TransformRows = Rows[Transform]
