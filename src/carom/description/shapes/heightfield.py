"""Terrain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import NO_MOMENTS, MassTerms
from carom.description.shapes.shape import Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, slots=True)
class Heightfield(Shape):
    """Terrain: heights on a grid, centred on its frame, z up.

    Attributes:
        heights: (columns along y, rows along x) heights, unscaled.
        scale: Distance between neighbours along x and y, and factor on the heights.
        middle: Unscaled height at the origin of the frame.
    """

    heights: NDArray[np.float64]
    scale: Vector3
    middle: float

    geom: ClassVar[int] = 9
    geom_name: ClassVar[str] = "GEOM_HEIGHTFIELD"
    is_ground: ClassVar[bool] = True

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        (columns, rows), (sx, sy, sz) = self.heights.shape, self.scale
        lowest, highest = float(self.heights.min()), float(self.heights.max())
        low, high = sorted((sz * (lowest - self.middle), sz * (highest - self.middle)))
        x, y = 0.5 * abs(sx) * (rows - 1), 0.5 * abs(sy) * (columns - 1)
        return Bounds.between((-x, -y, low), (x, y, high))

    def bullet_margin(self) -> float:
        return 0.0

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return NO_MOMENTS

    def collision_data(self, *, implicit_cylinder: bool) -> None:
        return None

    def call_arguments(self) -> dict[str, Any]:
        columns, rows = self.heights.shape
        return {
            "heightfieldData": self.heights.reshape(-1),
            "numHeightfieldRows": rows,
            "numHeightfieldColumns": columns,
            "meshScale": self.scale,
        }
