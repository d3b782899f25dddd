"""Image files as arrays of texels."""

from __future__ import annotations

import io
from pathlib import Path
from typing import NamedTuple
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import FileCache, FileStamp, read_bounded
from carom.files.budget import charge
from carom.render.plain_png import read_plain_png

Texels = NDArray[np.uint8]

# The tag that says how an image is to be turned when it is shown; textures are not turned.
_ORIENTATION = 0x0112


class ImageSource(NamedTuple):
    """Where an image comes from.

    Attributes:
        texels: Weak reference to the image.
        file: Its file.
        stamp: What the file was like when it was read.
        form: Pillow's names of the format and of the mode of the file; None if viewers turn the image.
    """

    texels: ref[Texels]
    file: Path
    stamp: FileStamp
    form: tuple[str, str] | None


sources: dict[int, ImageSource] = {}
"""Sources of the images that are in use, by their ids."""


def read_image(path: Path) -> Texels:
    """Read a PNG, JPEG, TGA, BMP or any other image that Pillow can decode.

    Files that have not changed since the last call come from a cache.

    Returns:
        (height, width, 3) red, green and blue, the top row first; read-only. The alpha channel is dropped:
        transparent pixels keep their colour.

    Raises:
        DescriptionError: The file is missing, too large, broken or not an image.
    """
    file = path.absolute()
    cached = _cache.get(file, file)
    if cached is not None:
        return cached
    with reading(file):
        data, stamp = read_bounded(file)
        texels, form = _decoded(data, file)
    texels.setflags(write=False)
    number = id(texels)
    sources[number] = ImageSource(ref(texels, lambda _: sources.pop(number, None)), file, stamp, form)
    _cache.put(file, stamp, texels)
    return texels


def _decoded(data: bytes, file: Path) -> tuple[Texels, tuple[str, str] | None]:
    plain = read_plain_png(data)
    if plain is not None:
        return plain[0], ("PNG", plain[1])
    from PIL import Image, UnidentifiedImageError

    try:
        with Image.open(io.BytesIO(data)) as image:
            charge("pixels", image.width * image.height)
            form = None if image.getexif().get(_ORIENTATION, 1) != 1 else (image.format or "", image.mode)
            texels = np.array(image.convert("RGB"))
    except UnidentifiedImageError:
        raise DescriptionError("the image cannot be read", file=file) from None
    # For broken files Pillow's decoders raise many types of exceptions.
    except (OSError, SyntaxError, ValueError, EOFError, Image.DecompressionBombError) as error:
        raise DescriptionError(f"the image is broken: {error}", file=file) from error
    if texels.size == 0:
        raise DescriptionError("the image has no texels", file=file)
    return texels, form


_cache: FileCache[Path, Texels] = FileCache(64)
