"""The textures of a world, by their texture ids."""

from __future__ import annotations

import numpy as np

from carom.native.change import Change
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
        change = Change()
        number = self.note(change, image)
        change.commit()
        return number

    def note(self, change: Change, image: Texels, *, hidden: bool = False) -> int:
        """Add an image with a change, and return its number.

        Scripts cannot refer to a hidden one; its number is less than `NO_TEXTURE`.
        """
        counter, following = ("_next_hidden", -1) if hidden else ("_next", 1)
        number = change.get(self, counter)
        change.set(self, counter, number + following)
        change.put(self._images, number, image)
        return number

    def replace(self, number: int, image: Texels) -> None:
        """Replace an image by another one, of any size."""
        change = Change()
        change.put(self._images, number, image)
        change.set(self, "changes", self.changes + 1)
        change.commit()

    def image(self, number: int) -> Texels:
        """The image of a texture; KeyError if there is none with this number."""
        return self._images[number]

    def clear(self) -> None:
        """Remove all images; their numbers are not used again."""
        change = Change()
        change.refill(self._images, {})
        change.set(self, "changes", self.changes + 1)
        change.commit()
