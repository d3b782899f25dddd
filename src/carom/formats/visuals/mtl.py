"""Materials of OBJ files: colour and texture."""

from __future__ import annotations

from math import isfinite
from pathlib import Path

from carom.description.link import Rgba
from carom.errors import DescriptionError
from carom.formats.files import read_bounded
from carom.lazy_dataclasses import dataclass
from carom.logger import Logger

_log = Logger("carom")

MAX_FILE_BYTES = 16 << 20
"""Largest material file that is read."""

BLACK: Rgba = (0.0, 0.0, 0.0, 1.0)
"""Colour of materials that have none, and of meshes without material that are asked for its colour."""


@dataclass(slots=True)
class ObjMaterial:
    """One material of a material file.

    Attributes:
        rgba: Diffuse colour and opacity; black, as in PyBullet, where the file gives no colour.
        texture: Image of the diffuse colour; it may be missing or broken.
    """

    rgba: Rgba = BLACK
    texture: Path | None = None


def read_materials(path: Path) -> dict[str, ObjMaterial]:
    """The materials of an MTL file by name; empty if it cannot be read, which is not an error."""
    try:
        data, _ = read_bounded(path, MAX_FILE_BYTES)
    except DescriptionError as error:
        _log.info("%s; the mesh has no materials", error)
        return {}
    materials: dict[str, ObjMaterial] = {}
    material = ObjMaterial()
    for number, line in enumerate(data.decode("utf-8", errors="surrogateescape").splitlines(), start=1):
        keyword, _, rest = line.strip().replace("\t", " ").partition(" ")
        rest = rest.strip()
        try:
            if keyword == "newmtl":
                material = materials.setdefault(first_word(rest), ObjMaterial())
            elif keyword == "Kd":
                red, green, blue = map(_finite, rest.split())
                material.rgba = (red, green, blue, material.rgba[3])
            elif keyword == "d":
                material.rgba = (*material.rgba[:3], _finite(rest))
            elif keyword == "Tr":
                material.rgba = (*material.rgba[:3], 1.0 - _finite(rest))
            elif keyword == "map_Kd" and rest:
                material.texture = _texture(path, rest)
        except ValueError:
            _log.warning("%s:%d: %s has invalid numbers %r; ignored", path, number, keyword, rest)
    return materials


def first_word(words: str) -> str:
    """The name of a material: what follows a space is no part of it."""
    return next(iter(words.split()), "")


def _finite(word: str) -> float:
    number = float(word)
    if not isfinite(number):
        raise ValueError(f"{word} is not finite")
    return number


def _texture(path: Path, words: str) -> Path:
    """The image named on a `map_Kd` line, relative to the material file."""
    name = words.replace("\\", "/")
    # Options such as "-s 1 1 1" come before the name, which may itself hold spaces.
    if name.startswith("-"):
        name = name.split()[-1]
    return path.parent / name
