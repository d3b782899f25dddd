"""All shapes that a link can have, and tables of them by their names in files and calls."""

from __future__ import annotations

from carom.description.shapes.box import Box
from carom.description.shapes.capsule import Capsule
from carom.description.shapes.convex_hull import ConvexHull
from carom.description.shapes.cylinder import Cylinder
from carom.description.shapes.ellipsoid import Ellipsoid
from carom.description.shapes.heightfield import Heightfield
from carom.description.shapes.mesh import Mesh
from carom.description.shapes.plane import Plane
from carom.description.shapes.rounded_box import RoundedBox
from carom.description.shapes.shape import Measure
from carom.description.shapes.signed_distance_field import SignedDistanceField
from carom.description.shapes.sphere import Sphere
from carom.description.shapes.triangle_mesh import TriangleMesh

MAX_SIZE = 1e15
"""Size [m] up to which scripts make and scale shapes; beyond it the normals of contacts are lost."""

Primitive = Box | Sphere | Cylinder | Capsule | Plane | RoundedBox | Ellipsoid
"""Shapes that a few numbers describe."""

Geometry = Primitive | Mesh | SignedDistanceField | ConvexHull | TriangleMesh | Heightfield

PRIMITIVES: tuple[type[Primitive], ...] = (Box, Sphere, Cylinder, Capsule, Plane, RoundedBox, Ellipsoid)
BY_TAG: dict[str, type[Primitive]] = {it.tag: it for it in PRIMITIVES if it.tag}
BY_GEOM: dict[int, type[Primitive]] = {it.geom: it for it in PRIMITIVES if it.geom_name}
BY_USD: dict[str, type[Primitive]] = {it.usd: it for it in PRIMITIVES if it.usd}
# Those of which MJCF files state sizes.
BY_MJCF: dict[str, type[Primitive]] = {it.mjcf: it for it in PRIMITIVES if it.size_count}

FLOOR = Plane()
"""A level plane, as formats have it whose planes state no normal."""


def measures(kind: type[Primitive]) -> tuple[Measure, ...]:
    """What files state of a primitive."""
    return tuple(it.measure for it in kind.parameters)
