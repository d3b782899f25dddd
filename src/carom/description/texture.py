"""Images on shapes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, slots=True)
class Texture:
    """An image on a shape, laid on by rules instead of texture coordinates.

    A cube has six square images side by side: right, left, up, down, front, back, those of the sides x, -x,
    y, -y, z and -z as OpenGL's cube maps have them. Each point of a shape shows what the ray from the middle
    of the shape through it meets there. Other images lie on planes from above, on each side of boxes, and
    around other shapes.

    Attributes:
        texels: (height, width, 3) red, green and blue, the top row first; None if it is from `files`.
        files: The image; of a cube all six, or one that is cut by `layout` or is on all sides.
        is_cube: See above.
        layout: Rows of letters that say which side each part of a single image of a cube is: one of `RLUDFB`,
            or `.` for none.
        repeat: How often the image is repeated along each axis: over the whole shape or, if it is `uniform`,
            in two metres.
        uniform: See `repeat`; a cube is then not stretched with the shape.
        size: Half extents of the shape [m]; 0 along an axis in which it has no end.
    """

    texels: NDArray[np.uint8] | None = None
    files: tuple[Path, ...] = ()
    is_cube: bool = False
    layout: tuple[str, ...] = ()
    repeat: tuple[float, float] = (1.0, 1.0)
    uniform: bool = False
    size: tuple[float, float, float] = (1.0, 1.0, 1.0)
