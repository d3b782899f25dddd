"""Distances on a grid from files, which nothing collides with."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import NO_MOMENTS, MassTerms
from carom.description.shapes.shape import ORIGIN, Shape


@dataclass(frozen=True, slots=True)
class SignedDistanceField(Shape):
    """A shape given by distances on a grid, from a file."""

    path: Path

    tag: ClassVar[str] = "cdf"
    # PyBullet has no constant for it.
    geom: ClassVar[int] = 8

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        return NO_MOMENTS

    def visual_data(self) -> tuple[int, Vector3, bytes]:
        return self.geom, ORIGIN, str(self.path).encode()

    def collision_data(self, *, implicit_cylinder: bool) -> None:
        return None
