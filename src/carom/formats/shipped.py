"""Suggestions for files that were not found: files of `pybullet_data`, and files with similar names."""

from __future__ import annotations

import os
from pathlib import Path

_CALL = "p.setAdditionalSearchPath(pybullet_data.getDataPath())"
# Least similarity of two names for a suggestion, from 0 to 1; see `difflib.get_close_matches`.
_LIKENESS = 0.75
# Longer names match no file, and are slow to compare.
_LONGEST_NAME = 255


def shipped_folder() -> Path | None:
    """The folder of `pybullet_data`; None if it is not installed."""
    # Imported late: only errors need it.
    from importlib.util import find_spec

    spec = find_spec("pybullet_data")
    if spec is None or not spec.submodule_search_locations:
        return None
    return Path(next(iter(spec.submodule_search_locations)))


def advice(name: Path, searched: tuple[Path | None, ...]) -> str:
    """A suggestion for a file that was not found, as the end of a sentence; empty if there is none.

    `searched` are the directories that were searched besides the working directory.
    """
    # `os.path`, which accepts names that no file can have.
    if os.path.exists(name):
        return "; it is not a regular file"
    folder = shipped_folder()
    near = _near(name, Path(name).parent)
    if folder is not None and not name.is_absolute() and folder not in searched:
        if os.path.isfile(folder / name):
            return f"; pybullet_data has one: call {_CALL} before"
        if meant := _near(name, folder / name.parent, name.parent):
            return f"; did you mean {meant} of pybullet_data? Then call {_CALL} before"
    elif folder is not None and folder in searched:
        near = near or _near(name, folder / name.parent, name.parent)
    return f"; did you mean {near}?" if near else ""


def _near(name: Path, folder: Path, prefix: Path | None = None) -> str:
    """The file in a folder whose name is most similar to the missing one; empty if none is similar."""
    if len(name.name) > _LONGEST_NAME:
        return ""
    try:
        names = [path.name for path in folder.iterdir() if path.suffix.lower() == name.suffix.lower()]
    except (OSError, ValueError):
        return ""
    from difflib import get_close_matches

    found = get_close_matches(name.name, names, 1, _LIKENESS)
    return str((prefix if prefix is not None else folder) / found[0]) if found else ""
