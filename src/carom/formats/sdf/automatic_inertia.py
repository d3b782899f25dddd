"""`<inertial auto="true">`: mass and inertia of a link from its shapes."""

from __future__ import annotations

from math import pi

import numpy as np

from carom.description import Ellipsoid, Geometry, Inertial, Mesh, Pose
from carom.description.shapes.moments import MassShape
from carom.description.transform import rotation_matrix
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.shapes.mesh_mass import mass_enclosed
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.polyline import prism, read_outline
from carom.formats.sdf.written_geometry import length, lengths, shape_of
from carom.meshes.reader import read_mesh
from carom.native.products import product, turned_tensor

_LEAST_VOLUME = 1e-15
_WATER = 1000.0
"""Density where none is stated [kg/m³]."""

Floats = np.ndarray


def automatic_inertia(
    context: SdfContext, inertial: Element, collisions: list[tuple[Element, list[Geometry], Pose]]
) -> Inertial | None:
    """The inertia of all shapes of a link together; None if none of them has a volume.

    The density of a shape is that of its `<collision>`, else of the `<inertial>`, else that of water; a mass
    that the `<inertial>` states scales the whole. Raises `DescriptionError`.
    """
    general = context.value(inertial, "density", _WATER)
    mass, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for element, geometries, pose in collisions:
        moments = _of_shape(context, element, geometries)
        if moments is None:
            continue
        volume, centre, spread = moments
        amount = context.value(element, "density", general) * volume
        turn = np.array(rotation_matrix(pose.orientation))
        middle = np.array(pose.position) + product(turn, centre[:, None])[:, 0]
        mass += amount
        first += amount * middle
        second += amount * (turned_tensor(turn, spread) + np.outer(middle, middle))
    if mass <= 0.0:
        return None
    centre = first / mass
    about = second - mass * np.outer(centre, centre)
    tensor = np.trace(about) * np.eye(3) - about
    if inertial.first("mass") is not None:
        wanted = context.non_negative(inertial, "mass")
        tensor *= wanted / mass
        mass = wanted
    x, y, z = centre.tolist()
    t = tensor.tolist()
    return Inertial(mass, Pose((x, y, z)), (t[0][0], t[0][1], t[0][2], t[1][1], t[1][2], t[2][2]))


Moments = tuple[float, Floats, Floats]


def _of_shape(context: SdfContext, collision: Element, geometries: list[Geometry]) -> Moments | None:
    """Of the shape of a `<collision>`; of those that are hulls here, by what they stand for."""
    shape = shape_of(context, collision)
    if shape.tag == "ellipsoid":
        return _spread(Ellipsoid(lengths(context, shape, "radii")).solid())
    if shape.tag == "cone":
        r, h = length(context, shape, "radius"), length(context, shape, "length")
        across, along = 3.0 / 20.0 * r * r, 3.0 / 80.0 * h * h
        # Its centre is a quarter of its height above its base.
        return pi / 3.0 * r * r * h, np.array((0.0, 0.0, -0.25 * h)), np.diag((across, across, along))
    if shape.tag == "polyline":
        surface = prism(*read_outline(context, collision, shape))
        return _enclosed(surface.vertices[surface.triangles])
    return _moments(geometries[0]) if geometries else None


def _spread(found: MassShape) -> Moments | None:
    spread = 0.5 * np.trace(found.tensor) * np.eye(3) - found.tensor
    return (found.measure, found.centre, spread) if found.measure > 0.0 else None


def _moments(geometry: Geometry) -> Moments | None:
    """Volume, centre, and mean of products of distances from it; None for what encloses no volume."""
    if isinstance(geometry, Mesh):
        parts = read_mesh(geometry.path)
        corners = np.concatenate([part.vertices[part.triangles] for part in parts]) * geometry.scale
        return _enclosed(corners)
    found = geometry.solid()
    return None if found is None else _spread(found)


def _enclosed(corners: Floats) -> Moments | None:
    found = mass_enclosed(corners, _LEAST_VOLUME)
    return None if found is None else _spread(found)
