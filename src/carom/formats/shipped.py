"""The files that come with `pybullet_data`, for who looks for them by name and for who forgot to."""

from __future__ import annotations

import os
from importlib.util import find_spec
from pathlib import Path

_CALL = "p.setAdditionalSearchPath(pybullet_data.getDataPath())"
# How alike names have to be for one to be meant by the other.
_LIKENESS = 0.75
# Longer names match none, and take long to compare.
_LONGEST_NAME = 255


def shipped_folder() -> Path | None:
    """Where the files of `pybullet_data` are; None where it is not installed."""
    spec = find_spec("pybullet_data")
    if spec is None or not spec.submodule_search_locations:
        return None
    return Path(next(iter(spec.submodule_search_locations)))


def advice(name: Path, searched: tuple[Path | None, ...]) -> str:
    """What to do about a file that was not found, as the end of a sentence; empty if there is nothing to say.

    Args:
        name: The name that was searched.
        searched: Directories that were searched besides the working directory.
    """
    folder = shipped_folder()
    near = _near(name, Path(name).parent)
    if folder is not None and not name.is_absolute() and folder not in searched:
        # `os.path`, which accepts names that no file can have.
        if os.path.isfile(folder / name):
            return f"; pybullet_data has one: call {_CALL} before"
        if meant := _near(name, folder / name.parent, name.parent):
            return f"; did you mean {meant} of pybullet_data? Then call {_CALL} before"
    elif folder is not None and folder in searched:
        near = near or _near(name, folder / name.parent, name.parent)
    return f"; did you mean {near}?" if near else ""


def _near(name: Path, folder: Path, prefix: Path | None = None) -> str:
    """A file in a folder whose name is like the one that is missing."""
    if len(name.name) > _LONGEST_NAME:
        return ""
    try:
        names = [path.name for path in folder.iterdir() if path.suffix.lower() == name.suffix.lower()]
    except (OSError, ValueError):
        return ""
    from difflib import get_close_matches

    found = get_close_matches(name.name, names, 1, _LIKENESS)
    return str((prefix if prefix is not None else folder) / found[0]) if found else ""
