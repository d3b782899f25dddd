"""The files that mesh files refer to: material files and images only.

They are embedded in a saved world, which may be given to others. So a mesh file must not be able to embed
arbitrary files by naming them: each has to be a regular file whose suffix is that of a material file or image
as expected, also after following symbolic links, and an image is checked by its first bytes as well.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from carom.files.unpacking import appears

_MATERIALS = frozenset({".mtl"})
_IMAGES = frozenset({".png", ".jpg", ".jpeg", ".bmp", ".tga", ".gif", ".tif", ".tiff", ".webp"})
_IMAGE_STARTS = (b"\x89PNG\r\n", b"\xff\xd8\xff", b"BM", b"GIF8", b"II*\0", b"MM\0*", b"RIFF")
# The third byte of a TGA file, its image type; these files have no signature at their start.
_TGA_TYPES = frozenset({1, 2, 3, 9, 10, 11})
_TAG, _END_TAG = b"<init_from>", b"</init_from>"


def references(path: Path, data: bytes) -> list[Path]:
    """The files that a mesh or material file with this content refers to and that may be embedded with it."""
    match path.suffix.lower():
        case ".obj":
            names, suffixes = _after_keyword(data, b"mtllib"), _MATERIALS
        case ".mtl":
            names, suffixes = map(_without_options, _after_keyword(data, b"map_Kd")), _IMAGES
        case ".dae":
            names, suffixes = _between_tags(data), _IMAGES
        case _:
            return []
    places = (Path(os.path.abspath(path.parent / os.fsdecode(name))) for name in names if name)
    return [place for place in dict.fromkeys(places) if _belongs(place, suffixes)]


def is_image(start: bytes, suffix: str) -> bool:
    """Whether the first bytes of a file are those of an image."""
    if suffix == ".tga":
        return len(start) > 2 and start[1] <= 1 and start[2] in _TGA_TYPES
    return start.startswith(_IMAGE_STARTS)


def _after_keyword(data: bytes, keyword: bytes) -> Iterator[bytes]:
    """The rest of the lines that begin with a keyword."""
    for line in data.splitlines():
        words = line.split(None, 1)
        if len(words) == 2 and words[0] == keyword:
            yield words[1].strip()


def _without_options(name: bytes) -> bytes:
    return name.split()[-1] if name.startswith(b"-") else name


def _between_tags(data: bytes) -> Iterator[bytes]:
    start = data.find(_TAG)
    while start >= 0:
        end = data.find(_END_TAG, start)
        if end < 0:
            return
        yield data[start + len(_TAG) : end].strip().removeprefix(b"file://")
        start = data.find(_TAG, end)


def _belongs(place: Path, suffixes: frozenset[str]) -> bool:
    """Whether a path is a regular file of the expected kind, also after following symbolic links."""
    try:
        target = place.resolve()
        appears(target)
        if not target.is_file() or {place.suffix.lower(), target.suffix.lower()} - suffixes:
            return False
        if suffixes is _MATERIALS:
            return True
        with target.open("rb") as stream:
            return is_image(stream.read(16), target.suffix.lower())
    except (OSError, ValueError, RuntimeError):
        # Names may contain characters that paths cannot have, and symbolic links may form a loop.
        return False
