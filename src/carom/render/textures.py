"""The textures of a world, by the numbers that scripts use."""

from __future__ import annotations

import numpy as np

from carom.render.images import Texels

NO_TEXTURE = -1

# Blue and white squares: the pattern of planes without a mesh and of soft solids.
CHECKER = np.array([[(173, 199, 255), (255, 255, 255)], [(255, 255, 255), (173, 199, 255)]], dtype=np.uint8)


class Textures:
    """Images by number. Numbers are never used again.

    Attributes:
        changes: Grows with every change.
    """

    def __init__(self) -> None:
        self.changes: int = 0
        self._images: dict[int, Texels] = {}
        self._next = 0
        self._next_hidden = NO_TEXTURE - 1

    def __contains__(self, number: object) -> bool:
        return number in self._images

    def add(self, image: Texels) -> int:
        """Enters an image (height, width, 3), the top row first, and returns its number."""
        number = self._next
        self._next += 1
        self._images[number] = image
        return number

    def add_hidden(self, image: Texels) -> int:
        """Enters an image that no script can name; its number is less than `NO_TEXTURE`."""
        number = self._next_hidden
        self._next_hidden -= 1
        self._images[number] = image
        return number

    def replace(self, number: int, image: Texels) -> None:
        """Replaces an image by another of any size."""
        self._images[number] = image
        self.changes += 1

    def image(self, number: int) -> Texels:
        """The image of a number; KeyError if there is none."""
        return self._images[number]

    def clear(self) -> None:
        """Forgets all images; their numbers are not used again."""
        self._images.clear()
        self.changes += 1
