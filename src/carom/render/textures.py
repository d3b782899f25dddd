"""The textures of a world, by their texture ids."""

from __future__ import annotations

import numpy as np

from carom.render.images import Texels

NO_TEXTURE = -1

# Blue and white squares: the texture of planes, height fields and soft solids.
CHECKER = np.array([[(173, 199, 255), (255, 255, 255)], [(255, 255, 255), (173, 199, 255)]], dtype=np.uint8)


class Textures:
    """Texture images by number. The number of a removed texture is never used again.

    Attributes:
        changes: Number of changes so far; it grows when images are replaced or removed.
    """

    def __init__(self) -> None:
        self.changes: int = 0
        self._images: dict[int, Texels] = {}
        self._next = 0
        self._next_hidden = NO_TEXTURE - 1

    def __contains__(self, number: object) -> bool:
        return number in self._images

    def add(self, image: Texels) -> int:
        """Add an image (height, width, 3), the top row first, and return its number."""
        number = self._next
        self._next += 1
        self._images[number] = image
        return number

    def add_hidden(self, image: Texels) -> int:
        """Add an image that scripts cannot refer to; its number is less than `NO_TEXTURE`."""
        number = self._next_hidden
        self._next_hidden -= 1
        self._images[number] = image
        return number

    def replace(self, number: int, image: Texels) -> None:
        """Replace an image by another one, of any size."""
        self._images[number] = image
        self.changes += 1

    def image(self, number: int) -> Texels:
        """The image of a texture; KeyError if there is none with this number."""
        return self._images[number]

    def clear(self) -> None:
        """Remove all images; their numbers are not used again."""
        self._images.clear()
        self.changes += 1
