"""Volume and moments of inertia of geoms, solid or with all mass on their surface."""

from __future__ import annotations

from math import pi

from carom.description.geometry import BY_MJCF
from carom.description.pose import Vector3
from carom.description.shapes.moments import MassShape


def mass_of_geom(kind: str, size: Vector3, *, shell: bool) -> MassShape | None:
    """The distribution of mass in a geom of a type, primitive or ellipsoid, by its sizes in MJCF [m].

    None for a shell that has no closed form, as that of an ellipsoid.
    """
    if kind in BY_MJCF:
        geometry = BY_MJCF[kind].of_sizes(*size)
        return geometry.shell() if shell else geometry.solid()
    return None if shell else mass_of_ellipsoid(size)


def mass_of_ellipsoid(axes: Vector3) -> MassShape:
    """The distribution of mass in a solid ellipsoid, by its half axes [m]."""
    a, b, c = axes
    moments = (0.2 * (b * b + c * c), 0.2 * (a * a + c * c), 0.2 * (a * a + b * b))
    return MassShape.central(4.0 / 3.0 * pi * a * b * c, moments)
