"""Writing descriptions as files; the ending of the name says in which format."""

from __future__ import annotations

from pathlib import Path

from carom.editing.mjcf_text import mjcf_text
from carom.editing.to_robots import write_robot
from carom.files.xml_element import Element
from carom.formats.kinds import USD_SUFFIXES
from carom.formats.reading.ignored import Ignored
from carom.formats.search import AssetSearch
from carom.writing import write_text

MJCF_SUFFIXES: tuple[str, ...] = (".xml", ".mjcf")
"""What names of MJCF files that are written end in."""
URDF_SUFFIX = ".urdf"


def write(root: Element, source: Path, search: AssetSearch, path: Path, model: str | None) -> list[Ignored]:
    """Write a description; gives what it has and the file does not say. See `Description.write`."""
    suffix = path.suffix.lower()
    if suffix in MJCF_SUFFIXES:
        if model is not None:
            raise ValueError("MJCF files have all robots; a model is for URDF and USD")
        write_text(path, mjcf_text(root, path.absolute().parent))
        return []
    if suffix != URDF_SUFFIX and suffix not in USD_SUFFIXES:
        endings = ", ".join((*MJCF_SUFFIXES, URDF_SUFFIX, *USD_SUFFIXES))
        raise ValueError(f"{path.name} ends in none of {endings}, which say what is written")
    return write_robot(root, source, search, path, model)
