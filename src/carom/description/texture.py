"""Images on shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class LateTexels:
    """Texels that are made when they are first asked for: most files that are loaded are never drawn."""

    __slots__ = ("_make", "_texels")

    def __init__(self, make: Callable[[], NDArray[np.uint8]]) -> None:
        """`make` returns what `Texture.texels` says."""
        self._make = make
        self._texels: NDArray[np.uint8] | None = None

    def made(self) -> NDArray[np.uint8]:
        """The texels, each time the same array."""
        if self._texels is None:
            self._texels = self._make()
        return self._texels


@dataclass(frozen=True, eq=False, slots=True)
class Texture:
    """An image on a shape, laid on by rules instead of texture coordinates.

    A cube has six square images side by side: right, left, up, down, front, back, those of the sides x, -x,
    y, -y, z and -z as OpenGL's cube maps have them. Each point of a shape shows what the ray from the middle
    of the shape through it meets there. Other images lie on planes from above, on each side of boxes, and
    around other shapes.

    Attributes:
        texels: (height, width, 3) red, green and blue, the top row first; None with `files` or `late`.
        files: The image; of a cube all six, or one that is cut by `layout` or is on all sides.
        is_cube: See above.
        layout: Rows of letters that say which side each part of a single image of a cube is: one of `RLUDFB`,
            or `.` for none.
        repeat: How often the image is repeated along each axis: over the whole shape or, if it is `uniform`,
            in two metres.
        uniform: See `repeat`; a cube is then not stretched with the shape.
        size: Half extents of the shape [m]; 0 along an axis in which it has no end.
        late: What makes `texels`, which are then None.
    """

    texels: NDArray[np.uint8] | None = None
    files: tuple[Path, ...] = ()
    is_cube: bool = False
    layout: tuple[str, ...] = ()
    repeat: tuple[float, float] = (1.0, 1.0)
    uniform: bool = False
    size: tuple[float, float, float] = (1.0, 1.0, 1.0)
    late: LateTexels | None = field(default=None, metadata={"saved": False})

    def with_texels(self) -> Texture:
        """The same with what is made late made now."""
        return self if self.late is None else replace(self, texels=self.late.made(), late=None)
