"""Textures as compressed files, for those who decode images themselves."""

from __future__ import annotations

from io import BytesIO
from typing import NamedTuple

import numpy as np

from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.render.images import Texels, sources

# Formats that browsers decode as Pillow does: (format, mode) of Pillow, and their media types.
_AS_THEY_ARE = {("PNG", "RGB"): "image/png", ("PNG", "RGBA"): "image/png", ("JPEG", "RGB"): "image/jpeg"}
# zlib's fastest level: others take several times as long for a few percent.
_LEVEL = 1


class TextureFile(NamedTuple):
    """An image as the bytes of a file.

    Attributes:
        media_type: `image/png` or `image/jpeg`.
        data: The file.
    """

    media_type: str
    data: bytes


def texture_file(texels: Texels) -> TextureFile:
    """An image as a file: as the one it was read from, if that is unchanged and short, else as a PNG file.

    Args:
        texels: (height, width, 3) red, green and blue, the top row first.
    """
    own = _own_file(texels)
    if own is not None and len(own.data) < texels.nbytes:
        return own
    from PIL import Image

    file = BytesIO()
    Image.fromarray(np.ascontiguousarray(texels)).save(file, "png", compress_level=_LEVEL)
    return TextureFile("image/png", file.getvalue())


def _own_file(texels: Texels) -> TextureFile | None:
    known = sources.get(id(texels))
    media_type = None if known is None or known.form is None else _AS_THEY_ARE.get(known.form)
    if known is None or media_type is None or known.texels() is not texels:
        return None
    try:
        if not known.stamp.is_of(known.file):
            return None
        data, _ = read_bounded(known.file)
    except (OSError, DescriptionError):
        return None
    return TextureFile(media_type, data)
