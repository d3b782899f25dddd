"""Triangles in memory."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds, product
from carom.description.shapes.moments import NO_MOMENTS, MassTerms
from carom.description.shapes.shape import Shape, as_unknown_mesh

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, slots=True)
class TriangleMesh(Shape):
    """A triangle mesh that is not replaced by its convex hull.

    Attributes:
        vertices: (n, 3) positions.
        triangles: (m, 3) indices into `vertices`, counter-clockwise seen from outside.
        margin: Collision margin: distance of the colliding surface from the triangles [m].
        scale: Factor along x, y and z that the vertices have been multiplied by.
        normals: (n, 3) normals for shading, if there are any.
        uvs: (n, 2) texture coordinates, if there are any.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.int32]
    margin: float = 0.0
    scale: Vector3 = (1.0, 1.0, 1.0)
    normals: NDArray[np.float64] | None = None
    uvs: NDArray[np.float64] | None = None

    mjcf: ClassVar[str] = "mesh"
    usd: ClassVar[str] = "Mesh"
    geom_name: ClassVar[str] = "GEOM_MESH"

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        return Bounds.of_points(self.vertices).grown(self.margin)

    def scaled(self, factors: Vector3) -> TriangleMesh:
        import numpy as np

        vertices = self.vertices * np.array(factors)
        return replace(self, vertices=vertices, scale=product(self.scale, factors))

    def lengths(self) -> tuple[float, ...]:
        return self.scale

    def bullet_margin(self) -> float:
        return self.margin

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return NO_MOMENTS

    def visual_dimensions(self) -> Vector3:
        return self.scale

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes]:
        return as_unknown_mesh()

    def call_arguments(self) -> dict[str, Any]:
        return {"vertices": self.vertices, "indices": self.triangles.reshape(-1)}
