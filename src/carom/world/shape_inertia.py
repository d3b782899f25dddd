"""Inertia of bodies of one shape whose mass is spread evenly."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.description import Geometry, Inertial, Mesh, Pose
from carom.errors import DescriptionError
from carom.meshes.reader import read_mesh
from carom.model.shape_pieces import joined_parts
from carom.model.written_inertia import written_inertia

if TYPE_CHECKING:
    from carom.description.shapes.moments import MassShape


def primitive_inertial(geometry: Geometry, mass: float) -> Inertial:
    """Inertia of a primitive of a mass [kg] > 0, in its own frame."""
    shape = geometry.solid()
    if shape is None:
        raise TypeError(f"{geometry!r} has no volume")
    return _along_principal_axes(shape, mass, "base")


def mesh_inertial(geometry: Geometry, mass: float) -> Inertial:
    """Inertia of the convex hull of a mesh of a mass [kg] > 0, in the frame of its principal axes.

    Raises:
        DescriptionError: The file cannot be used, or its hull has no volume.
    """
    from carom.formats.mjcf.compiled.shapes.mesh_mass import mass_of_mesh
    from carom.geometry.hull import hull_triangles

    assert isinstance(geometry, Mesh)
    vertices, triangles = joined_parts(read_mesh(geometry.path), geometry.scale)
    shape = mass_of_mesh(vertices, triangles, "convex", hull_triangles)
    if shape is None:
        raise DescriptionError("the mesh has no volume that its mass could fill", file=geometry.path)
    return _along_principal_axes(shape, mass, geometry.path.stem)


def _along_principal_axes(shape: MassShape, mass: float, name: str) -> Inertial:
    x, y, z = shape.centre.tolist()
    tensor = mass * np.asarray(shape.tensor)
    (ixx, ixy, ixz), (_, iyy, iyz), (_, _, izz) = tensor.tolist()
    stated = Inertial(mass, Pose((x, y, z)), (ixx, ixy, ixz, iyy, iyz, izz))
    (a, b, c), frame = written_inertia(stated, name)
    return Inertial(mass, frame, (a, 0.0, 0.0, b, 0.0, c))
