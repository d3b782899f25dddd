"""Checkpoints of environments: what changes in them, in a file.

A checkpoint is a file of NumPy (`.npz`) with the arrays and, as JSON, everything else. Reading it runs no
code from it.
"""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

import numpy as np

from carom.writing import write_whole

_DOCUMENT = "document"
_SKIPPED = object()


@runtime_checkable
class Resumable(Protocol):
    """An object that says itself what of it belongs to a checkpoint."""

    def checkpoint(self) -> dict[str, Any]:
        """What `resume` needs: numbers, texts and arrays, in dictionaries, lists and tuples."""
        ...

    def resume(self, saved: Mapping[str, Any]) -> None:
        """Continue from what `checkpoint` returned."""
        ...


class Attributes:
    """Base class of objects whose attributes that are numbers or arrays belong to a checkpoint.

    So do dictionaries, lists and tuples of nothing else, and attributes that are `Resumable`.
    """

    def checkpoint(self) -> dict[str, Any]:
        """See `Resumable`."""
        return attributes_of(self)

    def resume(self, saved: Mapping[str, Any]) -> None:
        """See `Resumable`."""
        set_attributes(self, saved)


def attributes_of(thing: object) -> dict[str, Any]:
    """The attributes of an object that belong to a checkpoint, see `Attributes`."""
    kept = {name: _kept(value) for name, value in vars(thing).items() if value is not None}
    return {name: value for name, value in kept.items() if value is not _SKIPPED}


def set_attributes(thing: object, saved: Mapping[str, Any]) -> None:
    """Set attributes to those of `attributes_of`.

    Arrays of the same shape and type are written in place, so that views of them stay views.
    """
    for name, value in saved.items():
        setattr(thing, name, _continued(getattr(thing, name, None), value))


def write_checkpoint(path: str | Path, content: Mapping[str, Any]) -> None:
    """Write what `attributes_of` returned to a file.

    Raises:
        OSError: The file cannot be written; an existing file is unchanged.
    """
    arrays: list[np.ndarray] = []
    document = json.dumps(_document(content, arrays)).encode()
    file = io.BytesIO()
    numbered = {str(number): array for number, array in enumerate(arrays)}
    np.savez(file, **{_DOCUMENT: np.frombuffer(document, np.uint8)}, **numbered)  # pyright: ignore[reportArgumentType]
    write_whole(path, file.getbuffer())


def read_checkpoint(path: str | Path) -> dict[str, Any]:
    """Read what `write_checkpoint` wrote.

    Raises:
        OSError: The file cannot be read.
        ValueError: It is not a checkpoint.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            document = json.loads(file[_DOCUMENT].tobytes())
            return _read(document, file)
    except (KeyError, TypeError, AttributeError, ValueError, EOFError, zipfile.BadZipFile) as problem:
        raise ValueError(f"{path} is not a checkpoint of an environment: {problem}") from problem


def _kept(value: Any) -> Any:
    """A copy of a value as it belongs to a checkpoint, or `_SKIPPED`."""
    if isinstance(value, np.ndarray):
        return _SKIPPED if value.dtype.hasobject else value.copy()
    if isinstance(value, np.generic):
        return value.item()
    if value is None or type(value) in (bool, int, float):
        return value
    if isinstance(value, Mapping):
        parts = {name: _kept(part) for name, part in value.items()}
        named = all(isinstance(name, str) for name in parts)
        return parts if named and not _any_skipped(parts.values()) else _SKIPPED
    if isinstance(value, (list, tuple)):
        parts = [_kept(part) for part in value]
        return type(value)(parts) if type(value) in (list, tuple) and not _any_skipped(parts) else _SKIPPED
    return value.checkpoint() if isinstance(value, Resumable) else _SKIPPED


def _any_skipped(parts: Iterable[Any]) -> bool:
    return any(part is _SKIPPED for part in parts)


def _continued(own: Any, saved: Any) -> Any:
    """What an attribute becomes: the saved value, in the memory and the objects that are there already."""
    if isinstance(own, Resumable):
        own.resume(saved)
        return own
    if isinstance(saved, np.ndarray):
        if isinstance(own, np.ndarray) and _fits(own, saved):
            own[...] = saved
            return own
        return saved.copy()
    if isinstance(saved, dict):
        parts = {
            name: _continued(own.get(name) if isinstance(own, Mapping) else None, part)
            for name, part in saved.items()
        }
        if not isinstance(own, dict):
            return parts
        own.clear()
        own.update(parts)
        return own
    if isinstance(saved, (list, tuple)):
        known = own if isinstance(own, (list, tuple)) and len(own) == len(saved) else [None] * len(saved)
        return type(saved)(_continued(part, other) for part, other in zip(known, saved, strict=True))
    return saved


def _fits(own: np.ndarray, saved: np.ndarray) -> bool:
    return own.shape == saved.shape and own.dtype == saved.dtype and own.flags.writeable


def _document(value: Any, arrays: list[np.ndarray]) -> Any:
    """A value as JSON has it; arrays are added to a list and named by their place in it."""
    if isinstance(value, np.ndarray):
        arrays.append(value)
        return {"array": len(arrays) - 1}
    if isinstance(value, Mapping):
        return {"dict": {name: _document(part, arrays) for name, part in value.items()}}
    if isinstance(value, (list, tuple)):
        return {type(value).__name__: [_document(part, arrays) for part in value]}
    return value


def _read(document: Any, arrays: Mapping[str, np.ndarray]) -> Any:
    if not isinstance(document, dict):
        return document
    ((kind, content),) = document.items()
    if kind == "array":
        return arrays[str(content)]
    if kind == "dict":
        return {name: _read(part, arrays) for name, part in content.items()}
    parts = [_read(part, arrays) for part in content]
    return tuple(parts) if kind == "tuple" else parts
