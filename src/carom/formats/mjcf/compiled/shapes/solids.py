"""Volume and moments of inertia of primitive shapes, solid or with all mass on their surface."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np
from numpy.typing import NDArray

from carom.description import Box, Capsule, Cylinder, Geometry, Sphere

Moments = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class MassShape:
    """How mass is distributed in a shape.

    Attributes:
        measure: Volume [m³]; of a shell its area [m²].
        centre: Centre of mass in the frame of the shape [m].
        tensor: (3, 3) inertia about that centre for each kilogram [m²].
    """

    measure: float
    centre: NDArray[np.float64]
    tensor: NDArray[np.float64]


def mass_of_primitive(kind: str, size: tuple[float, float, float], *, shell: bool) -> MassShape | None:
    """The distribution of mass in a sphere, capsule, cylinder, box or ellipsoid of MJCF sizes.

    Sizes are: radius; radius and half length; half extents. None for a shell that is an ellipsoid.
    """
    if kind == "ellipsoid" and shell:
        return None
    measure, moments = (_SHELLS if shell else _SOLIDS)[kind](*size)
    return MassShape(measure, np.zeros(3), np.diag(moments))


def mass_of_solid(geometry: Geometry) -> MassShape | None:
    """The distribution of mass in a solid sphere, box, cylinder or capsule; None for other geometry."""
    match geometry:
        case Sphere(radius):
            return mass_of_primitive("sphere", (radius, 0.0, 0.0), shell=False)
        case Box(half_extents):
            return mass_of_primitive("box", half_extents, shell=False)
        case Cylinder(radius, length):
            return mass_of_primitive("cylinder", (radius, 0.5 * length, 0.0), shell=False)
        case Capsule(radius, length):
            return mass_of_primitive("capsule", (radius, 0.5 * length, 0.0), shell=False)
        case _:
            return None


def _solid_sphere(r: float, *_: float) -> tuple[float, Moments]:
    moment = 0.4 * r * r
    return 4.0 / 3.0 * pi * r**3, (moment, moment, moment)


def _solid_ellipsoid(a: float, b: float, c: float) -> tuple[float, Moments]:
    return 4.0 / 3.0 * pi * a * b * c, (0.2 * (b * b + c * c), 0.2 * (a * a + c * c), 0.2 * (a * a + b * b))


def _solid_box(a: float, b: float, c: float) -> tuple[float, Moments]:
    return 8.0 * a * b * c, ((b * b + c * c) / 3.0, (a * a + c * c) / 3.0, (a * a + b * b) / 3.0)


def _solid_cylinder(r: float, h: float, *_: float) -> tuple[float, Moments]:
    across = r * r / 4.0 + h * h / 3.0
    return 2.0 * pi * r * r * h, (across, across, 0.5 * r * r)


def _solid_capsule(r: float, h: float, *_: float) -> tuple[float, Moments]:
    tube, ball = 2.0 * pi * r * r * h, 4.0 / 3.0 * pi * r**3
    volume = tube + ball
    # Each half ball has its centre 3/8 of the radius beyond the end of the tube.
    across = tube * (r * r / 4.0 + h * h / 3.0) + ball * (0.4 * r * r + h * h + 0.75 * r * h)
    along = tube * 0.5 * r * r + ball * 0.4 * r * r
    return volume, (across / volume, across / volume, along / volume)


def _sphere_shell(r: float, *_: float) -> tuple[float, Moments]:
    moment = 2.0 / 3.0 * r * r
    return 4.0 * pi * r * r, (moment, moment, moment)


def _box_shell(a: float, b: float, c: float) -> tuple[float, Moments]:
    # Pairs of faces across x, y and z; half extents.
    areas = (8.0 * b * c, 8.0 * a * c, 8.0 * a * b)
    squares = [0.0, 0.0, 0.0]
    half = (a, b, c)
    for across, area in enumerate(areas):
        for axis in range(3):
            squares[axis] += area * half[axis] ** 2 * (1.0 if axis == across else 1.0 / 3.0)
    total = sum(areas)
    x, y, z = (square / total for square in squares)
    return total, (y + z, x + z, x + y)


def _cylinder_shell(r: float, h: float, *_: float) -> tuple[float, Moments]:
    side, lids = 4.0 * pi * r * h, 2.0 * pi * r * r
    area = side + lids
    across = side * (0.5 * r * r + h * h / 3.0) + lids * (0.25 * r * r + h * h)
    along = side * r * r + lids * 0.5 * r * r
    return area, (across / area, across / area, along / area)


def _capsule_shell(r: float, h: float, *_: float) -> tuple[float, Moments]:
    side, ball = 4.0 * pi * r * h, 4.0 * pi * r * r
    area = side + ball
    # Each half sphere has its centre half of the radius beyond the end of the tube.
    across = side * (0.5 * r * r + h * h / 3.0) + ball * (2.0 / 3.0 * r * r + h * h + r * h)
    along = side * r * r + ball * 2.0 / 3.0 * r * r
    return area, (across / area, across / area, along / area)


_SOLIDS = {
    "sphere": _solid_sphere,
    "ellipsoid": _solid_ellipsoid,
    "box": _solid_box,
    "cylinder": _solid_cylinder,
    "capsule": _solid_capsule,
}
_SHELLS = {
    "sphere": _sphere_shell,
    "box": _box_shell,
    "cylinder": _cylinder_shell,
    "capsule": _capsule_shell,
}
