"""Convex hulls of points."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds, product
from carom.description.shapes.shape import Shape, as_unknown_mesh
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, slots=True)
class ConvexHull(Shape):
    """The convex hull of points.

    Attributes:
        points: (n, 3) positions.
        scale: Factor along x, y and z that the points have been multiplied by.
        margin: Distance of the colliding surface from the hull [m]; 0 for the hull of exactly these points.
        uses: (n,) how often a file's triangles have each point as a corner, on which PyBullet's order of the
            hull's corners depends; None for once.
        keeps_all: It collides with all its corners, as MuJoCo's meshes, also where others are simplified.
    """

    points: NDArray[np.float64]
    scale: Vector3 = (1.0, 1.0, 1.0)
    margin: float = MARGIN
    uses: NDArray[np.int32] | None = None
    keeps_all: bool = False

    mjcf: ClassVar[str] = "mesh"
    usd: ClassVar[str] = "Mesh"
    geom_name: ClassVar[str] = "GEOM_MESH"

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds.of_points(self.points).grown(MARGIN).grown(MARGIN)

    def scaled(self, factors: Vector3) -> ConvexHull:
        import numpy as np

        points = self.points * np.array(factors)
        return replace(self, points=points, scale=product(self.scale, factors))

    def lengths(self) -> tuple[float, ...]:
        return self.scale

    def visual_dimensions(self) -> Vector3:
        return self.scale

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes]:
        return as_unknown_mesh()

    def call_arguments(self) -> dict[str, Any]:
        return {"vertices": self.points}
