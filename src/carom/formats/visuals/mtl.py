"""Materials of OBJ files: colour and texture, and which the groups of a file have."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import islice
from math import isfinite
from pathlib import Path

from carom.description.link import Rgba
from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.files.budget import BudgetError, charge
from carom.logger import Logger

_log = Logger("carom")

# More material files than anybody has would take long to look for.
_MAX_LIBRARIES = 1000

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


@dataclass(repr=False, eq=False, slots=True)
class ObjGroups:
    """The groups of an OBJ file that have faces, and their materials.

    Attributes:
        libraries: Names of the material files, once each.
        materials: Of each group the material in use at its end, and how many material files had been named
            where its use began.
        material: That in use now.
        face_count: How many faces the groups so far have.
    """

    libraries: dict[str, None] = field(default_factory=dict)
    materials: list[tuple[str, int]] = field(default_factory=list)
    material: tuple[str, int] = ("", 0)
    face_count: int = 0

    def note(self, keyword: bytes, rest: bytes, faces: int) -> None:
        """Note a line, and how many faces are before it."""
        if keyword in (b"g", b"o"):
            self.end(faces)
        elif keyword == b"usemtl":
            self.material = (_first_word(rest.decode("utf-8", errors="surrogateescape")), len(self.libraries))
        elif keyword == b"mtllib":
            self.libraries.setdefault(rest.strip().decode("utf-8", errors="surrogateescape"))

    def end(self, faces: int) -> None:
        """End a group; so many faces are before its end."""
        self.materials += [self.material] * (faces > self.face_count)
        self.face_count = faces

    def material_of_all(self, folder: Path) -> ObjMaterial | None:
        """The material of the whole mesh; None if that of its last group is unknown.

        Files are looked for in the folder of the mesh. It is the first material in use that has a texture, or
        that of the last group.
        """
        known: list[dict[str, ObjMaterial]] = [{}]
        for name in islice(self.libraries, _MAX_LIBRARIES):
            known.append(known[-1] | read_materials(folder / name))
            charge("elements", len(known[-1]))
        used = [known[min(count, len(known) - 1)].get(name) for name, count in self.materials]
        with_texture = [it for it in used if it is not None and it.texture is not None]
        return with_texture[0] if with_texture else used[-1] if used else None


def read_materials(path: Path) -> dict[str, ObjMaterial]:
    """The materials of an MTL file by name; empty if it cannot be read, which is not an error."""
    try:
        data, _ = read_bounded(path, "document_bytes")
    except BudgetError:
        raise
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
                material = materials.setdefault(_first_word(rest), ObjMaterial())
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


def _first_word(words: str) -> str:
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
