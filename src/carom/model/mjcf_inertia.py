"""Rotational inertia as PyBullet computes it for the links of MJCF files."""

from __future__ import annotations

from dataclasses import replace
from functools import reduce

from carom.description import Collision, Mesh, Pose
from carom.description.pose import Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import TWELFTH
from carom.layouts.contacts import MARGIN
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.bounds import vertex_bounds
from carom.model.inertia import bounds_in, box_moments, inertia_from_shapes, is_in_place, placement
from carom.model.swept_spheres import FIRST_MARGIN


def set_mjcf_inertias(body: BodySpec) -> None:
    """Set the inertias of a body's links to those that PyBullet computes for MJCF files.

    There cylinders are exact, and compounds have no margin.

    Raises:
        DescriptionError: The file of a collision mesh cannot be used.
    """
    if body.flags & LoadFlags.USE_INERTIA_FROM_FILE:
        return
    for link in (body.base, *body.links):
        if link.mass != 0.0:
            link.inertia = _inertia(link)


def _inertia(link: LinkSpec) -> Vector3:
    mass, collisions, frame = link.mass, link.collisions, link.inertial_frame
    if not any(_is_stl(collision) for collision in collisions):
        return inertia_from_shapes(replace(link, compound_margin=0.0), implicit_cylinder=True)
    if is_in_place(collisions, frame):
        return box_moments(mass * TWELFTH, _stl_bounds(collisions[0]).grown(MARGIN))
    boxes = [_placed(collision, frame) for collision in collisions]
    return box_moments(mass / 12.0, reduce(Bounds.joined, boxes))


def _placed(collision: Collision, frame: Pose) -> Bounds:
    """Bounds of a shape along the axes of an inertial frame."""
    if _is_stl(collision):
        return _stl_bounds(collision).placed(*placement(frame, collision.frame))
    return bounds_in(frame, collision, implicit_cylinder=True)


def _is_stl(collision: Collision) -> bool:
    geometry = collision.geometry
    return isinstance(geometry, Mesh) and geometry.path.suffix.lower() == ".stl"


def _stl_bounds(collision: Collision) -> Bounds:
    """Bounds of the hull of an STL file: PyBullet sets its margin only after the first of two uses."""
    geometry = collision.geometry
    assert isinstance(geometry, Mesh), "only meshes come from STL files"
    return vertex_bounds(geometry).grown(FIRST_MARGIN).grown(MARGIN)
