"""Meshes from files; `carom.model` reads these where their content matters."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds, product
from carom.description.shapes.moments import NO_MOMENTS, MassTerms, box_terms
from carom.description.shapes.shape import Shape
from carom.layouts.contacts import MARGIN


@dataclass(frozen=True, slots=True)
class Mesh(Shape):
    """A triangle mesh from a file.

    Attributes:
        path: The file, as it was found.
        scale: Factor along x, y and z, the global scaling included.
        concave: The triangles themselves collide, not their convex hull (static bodies only).
        asked_for: The file name that a script passed; empty if no script did.
        margin: Distance of the colliding surface from the hull [m]: PyBullet's, or 0 where a file means the
            hull itself.
    """

    path: Path
    scale: Vector3 = (1.0, 1.0, 1.0)
    concave: bool = False
    asked_for: str = field(default="", compare=False)
    margin: float = MARGIN

    tag: ClassVar[str] = "mesh"
    mjcf: ClassVar[str] = "mesh"
    usd: ClassVar[str] = "Mesh"
    geom_name: ClassVar[str] = "GEOM_MESH"

    def is_compound(self) -> bool:
        """Whether it is several hulls in PyBullet, one for each group of an OBJ file."""
        return not self.concave and self.path.suffix.lower() == ".obj"

    def scaled(self, factors: Vector3) -> Mesh:
        return replace(self, scale=product(self.scale, factors))

    def lengths(self) -> tuple[float, ...]:
        return self.scale

    def bullet_margin(self) -> float:
        return 0.0 if self.concave else MARGIN

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        if self.concave:
            return NO_MOMENTS
        if self.is_compound():
            return box_terms(12.0, 1.0, bounds.grown(margin - MARGIN))
        return Shape.mass_terms(self, bounds, margin, implicit_cylinder=implicit_cylinder)

    def visual_data(self) -> tuple[int, Vector3, bytes]:
        # The name that a script gave, or the path of a file that a robot file names.
        return self.geom, self.scale, (self.asked_for or str(self.path)).encode()

    def call_arguments(self) -> dict[str, Any]:
        return {"fileName": str(self.path.absolute()), "meshScale": self.scale}
