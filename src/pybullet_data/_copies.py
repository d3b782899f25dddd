"""Which folder `getDataPath` gives: Carom's own, or the user's copy of PyBullet's files.

`python -m carom data --from-pybullet` makes copies and says which one is served; the environment variable
`CAROM_PYBULLET_DATA` names a folder for one process and those it starts.
"""

import os
import sys

VARIABLE = "CAROM_PYBULLET_DATA"
"""A folder to be served as it is, or `own` for Carom's own files."""

OWN = "own"
SERVED = "served"
"""A file beside the copies, with the name of the folder of the one that is served."""

# Files of PyBullet's package, and of Carom's, that tell such a folder from any other.
_ALWAYS_THERE = ("plane.urdf", "r2d2.urdf", os.path.join("kuka_iiwa", "model.urdf"))


def copies_folder() -> str:
    """The folder of copies, one below it for each; it may not exist."""
    if sys.platform == "win32":
        base = os.environ.get("LOCALAPPDATA") or os.path.expanduser(r"~\AppData\Local")
    elif sys.platform == "darwin":
        base = os.path.expanduser("~/Library/Application Support")
    else:
        base = os.environ.get("XDG_DATA_HOME") or os.path.expanduser("~/.local/share")
    return os.path.join(base, "carom", "pybullet_data")


def is_data_folder(folder: str) -> bool:
    """Whether a folder has what every `pybullet_data` has."""
    return all(os.path.isfile(os.path.join(folder, name)) for name in _ALWAYS_THERE)


def served_copy() -> str | None:
    """The copy that is served; None if none is.

    Raises:
        FileNotFoundError: It has been removed, or is incomplete.
    """
    copies = copies_folder()
    try:
        with open(os.path.join(copies, SERVED), encoding="utf-8") as file:
            name = file.read().strip()
    except (FileNotFoundError, NotADirectoryError):
        return None
    return _checked(os.path.join(copies, name), "`python -m carom data --own` goes back to Carom's own files")


def data_folder(own: str) -> str:
    """The folder to be served; `own` is Carom's.

    Raises:
        FileNotFoundError: The folder that is asked for is not one of `pybullet_data`.
    """
    named = os.environ.get(VARIABLE)
    if named == OWN:
        return own
    if named:
        return _checked(os.path.abspath(named), f"{VARIABLE} names it")
    return served_copy() or own


def _checked(folder: str, advice: str) -> str:
    if not is_data_folder(folder):
        raise FileNotFoundError(f"{folder} has not the files of pybullet_data; {advice}")
    return folder
