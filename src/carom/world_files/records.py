"""Values of the document of a saved world: numbers, texts, arrays, files, and dataclasses of them.

The type of a value determines how it is written; the expected type of each field determines how it is read.
So a file cannot name code to run. A dataclass is written as an object of its fields, with the name of the
class under `is`; an enumeration as its value; an array as `{"array": type, "shape": [...], "at": offset}`; a
path as the number of an embedded file (`carom.world_files.files`).
"""

from __future__ import annotations

import types
from collections.abc import Callable
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from functools import cache
from math import isnan
from pathlib import Path
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from carom.description.texture import Texture
from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.world_files.container import Blocks
from carom.world_files.files import FileTable

T = TypeVar("T")

_CLASS = "is"
_ARRAY_TYPES = ("<f8", "<f4", "<i4", "|u1", "|b1")
_LARGEST = 2**63


class Writer:
    """Converts values to parts of a document, which refers to its `blocks` of bytes and its `files`."""

    def __init__(self) -> None:
        self.blocks: Blocks = Blocks()
        self.files: FileTable = FileTable(self.blocks)
        self._arrays: dict[int, tuple[np.ndarray, dict[str, Any]]] = {}

    def write(self, value: Any) -> Any:
        """The JSON form of a value in the document."""
        if isinstance(value, Enum):
            return value.value
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        if isinstance(value, np.ndarray):
            return self._array(value)
        if isinstance(value, Path):
            return self.files.add(value)
        if isinstance(value, (list, tuple)):
            return [self.write(item) for item in value]
        if isinstance(value, dict):
            return {str(key): self.write(item) for key, item in value.items()}
        assert is_dataclass(value), f"{type(value)} cannot be saved"
        if isinstance(value, Texture):
            value = value.with_texels()
        record = {field.name: self.write(getattr(value, field.name)) for field in _saved_fields(value)}
        return {_CLASS: type(value).__name__, **record}

    def _array(self, array: np.ndarray) -> dict[str, Any]:
        # The array is kept alive so that no other array gets the same `id`.
        known = self._arrays.get(id(array))
        if known is None:
            data = np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<"), copy=False)
            record = {
                "array": data.dtype.str,
                "shape": list(data.shape),
                "at": self.blocks.add(data.tobytes()),
            }
            known = self._arrays[id(array)] = (array, record)
        return known[1]


class Reader:
    """Converts parts of a document to values of the expected types.

    They refer to blocks of bytes, and to embedded files by their numbers.
    """

    def __init__(self, file: Path, blocks: memoryview, files: list[Path]) -> None:
        self._file = file
        self._blocks = blocks
        self._files = files

    def fail(self, where: str, reason: str) -> DescriptionError:
        """An error about a part of the document, to be raised."""
        return DescriptionError(f"{where} {reason}", file=self._file)

    def read(self, hint: Any, data: Any, where: str) -> Any:
        """Read a value of an expected type from its JSON form; `where` is its place, for error messages.

        Raises:
            DescriptionError: The value is not of that type.
        """
        hint = _without_alias(hint)
        if get_origin(hint) in (Union, types.UnionType):
            return self._one_of(get_args(hint), data, where)
        if get_origin(hint) is np.ndarray:
            return self.array(data, np.dtype(get_args(get_args(hint)[1])[0]), None, where)
        if get_origin(hint) in _CONTAINERS:
            return _CONTAINERS[get_origin(hint)](self, get_args(hint), data, where)
        if hint in _SCALARS:
            return _SCALARS[hint](self, data, where)
        if issubclass(hint, Enum):
            try:
                return hint(data)
            except (ValueError, TypeError):
                raise self.fail(where, f"is not a value of {hint.__name__}") from None
        return self.record(hint, data, where)

    def record(self, cls: type[T], data: Any, where: str) -> T:
        """Read a dataclass; fields with a default may be missing, as in files of earlier versions."""
        if not isinstance(data, dict) or data.get(_CLASS) != cls.__name__:
            raise self.fail(where, f"is not of type {cls.__name__}")
        hints = _hints(cls)
        given = data.keys() - {_CLASS}
        if not _required(cls) <= given <= hints.keys():
            raise self.fail(where, f"does not have the fields of a {cls.__name__}")
        return cls(**{name: self.read(hints[name], data[name], f"{where}.{name}") for name in given})

    def array(
        self,
        data: Any,
        dtype: np.dtype,
        shape: tuple[int | None, ...] | None,
        where: str,
        *,
        may_be_nan: bool = False,
    ) -> np.ndarray:
        """Read an array; in the shape, and instead of it, None allows any.

        With `may_be_nan`, it may contain NaN.

        Raises:
            DescriptionError: The array has another type or shape, or contains NaN.
        """
        if not isinstance(data, dict) or data.keys() != {"array", "shape", "at"}:
            raise self.fail(where, "is not an array")
        sizes = self.read(list[int], data["shape"], f"{where}.shape")
        at = self.read(int, data["at"], f"{where}.at")
        if data["array"] not in _ARRAY_TYPES or np.dtype(data["array"]) != dtype:
            raise self.fail(where, f"has entries of type {data['array']!r} instead of {dtype.str!r}")
        wanted = [None] * len(sizes) if shape is None else list(shape)
        if len(wanted) != len(sizes) or any(w not in (None, s) for w, s in zip(wanted, sizes, strict=True)):
            raise self.fail(where, f"has shape {sizes}, which does not fit")
        count = 1
        for size in sizes:
            count *= size
        if min(sizes, default=0) < 0 or at < 0 or at + count * dtype.itemsize > len(self._blocks):
            raise self.fail(where, "lies outside the file")
        charge("world_bytes", count * dtype.itemsize)
        array = np.frombuffer(self._blocks, dtype, count, at).reshape(sizes).copy()
        if dtype.kind == "f" and not may_be_nan and np.isnan(array).any():
            raise self.fail(where, "contains NaN")
        return array

    def _one_of(self, hints: tuple[Any, ...], data: Any, where: str) -> Any:
        if data is None and type(None) in hints:
            return None
        hints = tuple(hint for hint in hints if hint is not type(None))
        if len(hints) == 1:
            return self.read(hints[0], data, where)
        name = data.get(_CLASS) if isinstance(data, dict) else None
        for hint in hints:
            if hint.__name__ == name:
                return self.record(hint, data, where)
        raise self.fail(where, f"is not one of the types {', '.join(hint.__name__ for hint in hints)}")

    def _number(self, data: Any, where: str) -> float:
        if isinstance(data, bool) or not isinstance(data, (int, float)) or isnan(data):
            raise self.fail(where, "is not a number")
        try:
            return float(data)
        except OverflowError:
            raise self.fail(where, "is too large") from None

    def _integer(self, data: Any, where: str) -> int:
        if isinstance(data, bool) or not isinstance(data, int) or not -_LARGEST <= data < _LARGEST:
            raise self.fail(where, "is not an integer of 64 bits")
        return data

    def _flag(self, data: Any, where: str) -> bool:
        if not isinstance(data, (bool, int)):
            raise self.fail(where, "is neither true nor false")
        return bool(data)

    def _text(self, data: Any, where: str) -> str:
        if not isinstance(data, str):
            raise self.fail(where, "is not a text")
        return data

    def _path(self, data: Any, where: str) -> Path:
        number = self._integer(data, where)
        if not 0 <= number < len(self._files):
            raise self.fail(where, "is not the number of an embedded file")
        return self._files[number]

    def items(self, data: Any, where: str) -> list[tuple[str, Any]]:
        """The items of a list, each with its place in the document."""
        if not isinstance(data, list):
            raise self.fail(where, "is not a list")
        return [(f"{where}[{place}]", item) for place, item in enumerate(data)]

    def _list(self, hints: tuple[Any, ...], data: Any, where: str) -> list[Any]:
        return [self.read(hints[0], item, place) for place, item in self.items(data, where)]

    def _tuple(self, hints: tuple[Any, ...], data: Any, where: str) -> tuple[Any, ...]:
        items = self.items(data, where)
        if hints[-1] is Ellipsis:
            hints = (hints[0],) * len(items)
        if len(hints) != len(items):
            raise self.fail(where, f"has {len(items)} items instead of {len(hints)}")
        return tuple(self.read(hint, item, place) for hint, (place, item) in zip(hints, items, strict=True))

    def _dict(self, hints: tuple[Any, ...], data: Any, where: str) -> dict[str, Any]:
        if not isinstance(data, dict):
            raise self.fail(where, "is not an object")
        return {key: self.read(hints[1], item, f"{where}[{key!r}]") for key, item in data.items()}


_SCALARS: dict[Any, Callable[[Reader, Any, str], Any]] = {
    float: Reader._number,
    int: Reader._integer,
    bool: Reader._flag,
    str: Reader._text,
    Path: Reader._path,
}
_CONTAINERS: dict[Any, Callable[[Reader, tuple[Any, ...], Any, str], Any]] = {
    list: Reader._list,
    tuple: Reader._tuple,
    dict: Reader._dict,
}


def _without_alias(hint: Any) -> Any:
    """The type that an alias stands for: `NDArray` is a type alias from NumPy 2.5 on."""
    meant = getattr(get_origin(hint), "__value__", None)
    return hint if meant is None else meant[get_args(hint)]


def _saved_fields(cls: Any) -> list[Field[Any]]:
    """The fields of a dataclass but for those that say that they are not saved."""
    return [field for field in fields(cls) if field.metadata.get("saved", True)]


@cache
def _required(cls: Any) -> frozenset[str]:
    """The fields of a dataclass that have no default."""
    return frozenset(field.name for field in fields(cls) if field.default is MISSING)


@cache
def _hints(cls: Any) -> dict[str, Any]:
    """Types of the fields of a dataclass, also those that its module imports for type checkers only."""
    from carom.description.actuator import ActuatorSpec
    from carom.description.compliance import Compliance, ContactCompliance
    from carom.description.fluid import FluidEllipsoid
    from carom.description.keyframe import BodyKeyframe
    from carom.description.sensor import SensorSpec
    from carom.description.site import SiteSpec
    from carom.model.soft_spec import SoftSpec

    types = (
        *(ActuatorSpec, BodyKeyframe, Compliance, ContactCompliance),
        *(FluidEllipsoid, SensorSpec, SiteSpec, SoftSpec, Texture),
    )
    specs = {it.__name__: it for it in types}
    hints = get_type_hints(cls, localns={"np": np, "NDArray": NDArray, **specs, "LateTexels": object})
    return {field.name: hints[field.name] for field in _saved_fields(cls)}
