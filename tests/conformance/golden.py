"""Golden files: the series of one scenario as real PyBullet gave them.

An archive holds `index.json` (PyBullet's version; name, kind and shape of every series) and one
array per kind with the numbers of all series in a row, which keeps files of hundreds of small
tables compact. Time stamps inside are fixed, so recording the same figures again leaves the file
as it was.
"""

from __future__ import annotations

import io
import json
import math
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .scenario import Series

DIRECTORY = Path(__file__).resolve().parent / "golden"
_INDEX = "index.json"
_EPOCH = (1980, 1, 1, 0, 0, 0)
_TYPES = {"real": np.dtype("<f8"), "whole": np.dtype("<i8"), "text": np.dtype("<U64")}


@dataclass(frozen=True)
class Golden:
    """What an engine of one version measured in one scenario."""

    engine: str
    series: Series


def path_of(name: str) -> Path:
    """Where the golden of a scenario lies."""
    return DIRECTORY / f"{name}.npz"


def names() -> list[str]:
    """Names of all scenarios that have a golden, sorted."""
    return sorted(path.stem for path in DIRECTORY.glob("*.npz"))


def write(path: Path, golden: Golden) -> None:
    """Write an archive that `read` gives back exactly."""
    index = []
    columns: dict[str, list[np.ndarray]] = {kind: [] for kind in _TYPES}
    for name, values in golden.series.items():
        kind = _kind_of(name, values)
        index.append([name, kind, list(values.shape)])
        columns[kind].append(values.astype(_TYPES[kind]).ravel())
    with zipfile.ZipFile(path, "w") as archive:
        _put(archive, _INDEX, json.dumps({"engine": golden.engine, "series": index}).encode())
        for kind, parts in columns.items():
            if parts:
                buffer = io.BytesIO()
                np.lib.format.write_array(buffer, np.concatenate(parts), allow_pickle=False)
                _put(archive, f"{kind}.npy", buffer.getvalue())


def read(path: Path) -> Golden:
    """Read an archive written by `write`."""
    with zipfile.ZipFile(path) as archive:
        index = json.loads(archive.read(_INDEX))
        columns = {
            entry.removesuffix(".npy"): np.lib.format.read_array(
                io.BytesIO(archive.read(entry)), allow_pickle=False
            )
            for entry in archive.namelist()
            if entry != _INDEX
        }
    series: Series = {}
    start = dict.fromkeys(columns, 0)
    for name, kind, shape in index["series"]:
        end = start.get(kind, 0) + math.prod(shape)
        series[name] = columns[kind][start[kind] : end].reshape(shape)
        start[kind] = end
    return Golden(index["engine"], series)


def _kind_of(name: str, values: np.ndarray) -> str:
    kind = {"f": "real", "i": "whole", "b": "whole", "U": "text"}.get(values.dtype.kind)
    if kind is None:
        raise TypeError(f"series {name} holds neither numbers nor text but {values.dtype}")
    if kind == "text" and values.dtype.itemsize > _TYPES["text"].itemsize:
        raise ValueError(f"series {name} holds text longer than 64 characters")
    return kind


def _put(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    info = zipfile.ZipInfo(name, date_time=_EPOCH)
    archive.writestr(info, content, zipfile.ZIP_DEFLATED, 9)
