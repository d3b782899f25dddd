"""Flexes whose points all move with one body: they are part of its shape, rounded by their radius."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.description import Collision, Visual
from carom.description.geometry import Capsule, ConvexHull, Geometry, TriangleMesh
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import turn_of_z
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.contact import read_contact
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.model import CompiledBody
from carom.native.products import length

Floats = NDArray[np.float64]
_CABLE, _CLOTH, _SOLID = 1, 2, 3


def add_rigid_flex(
    scope: Scope,
    element: Element,
    flex: FileFlex,
    points: Floats,
    body: CompiledBody,
    options: Mapping[str, Any],
) -> None:
    """Add the shapes of a flex to its body, which gets no mass from it, as in MuJoCo.

    Args:
        scope: The reading of its file.
        element: The `<flex>` or `<flexcomp>`.
        flex: The flex.
        points: (n, 3) its points in the frame of the body [m].
        body: The body.
        options: Those of the file.

    Raises:
        DescriptionError: A number of its `<contact>` is wrong.
    """
    for child in element.children:
        child.note()
    shapes = list(_shapes(flex, points))
    charge("vertices", len(shapes) * (flex.cells.shape[1]))
    contact = element.first("contact")
    kinds = (1, 1)
    if contact is not None:
        stated = contact.attributes
        first, second = (
            int(scope.context.number(contact, stated, it, 1.0)) for it in ("contype", "conaffinity")
        )
        kinds = (first, second)
    touching = read_contact(scope, element if contact is None else contact, options, is_mesh=True)
    if kinds != (0, 0):
        if not body.collisions:
            body.contact = touching
        own = None if touching == body.contact else touching
        body.collisions += [Collision(*it, flex.name, *kinds, contact=own) for it in shapes]
    seen = shapes if flex.cells.shape[1] == _CABLE + 1 else [(_surface(flex, points), IDENTITY)]
    body.visuals += [Visual(*it, flex.name, flex.material) for it in seen]


def _shapes(flex: FileFlex, points: Floats) -> Iterator[tuple[Geometry, Pose]]:
    """A shape for each element: as in MuJoCo, all within the radius of it."""
    for cell in flex.cells.tolist():
        corners = points[cell]
        if len(cell) == _CABLE + 1 and flex.radius > 0.0:
            between = corners[1] - corners[0]
            size = float(length(between))
            x, y, z = (between / size).tolist() if size else (0.0, 0.0, 1.0)
            u, v, w = (0.5 * (corners[0] + corners[1])).tolist()
            yield Capsule(flex.radius, size), Pose((u, v, w), turn_of_z((x, y, z)))
        else:
            yield ConvexHull(corners, margin=flex.radius), IDENTITY


def _surface(flex: FileFlex, points: Floats) -> TriangleMesh:
    """Its triangles, or the sides that tetrahedra have alone, seen from outside."""
    cells = flex.cells
    if cells.shape[1] == _CLOTH + 1:
        return TriangleMesh(points, cells)
    sides = np.concatenate([cells[:, side] for side in ((1, 2, 3), (0, 2, 3), (0, 1, 3), (0, 1, 2))])
    opposite = points[cells.T.reshape(-1)]
    _, places, counts = np.unique(np.sort(sides, axis=1), axis=0, return_index=True, return_counts=True)
    alone = np.sort(places[counts == 1])
    sides, a, b, c = sides[alone], *(points[sides[alone, corner]] for corner in range(3))
    inward = (np.cross(b - a, c - a) * (opposite[alone] - a)).sum(axis=1) > 0.0
    sides[inward] = sides[inward][:, ::-1]
    return TriangleMesh(points, sides)
