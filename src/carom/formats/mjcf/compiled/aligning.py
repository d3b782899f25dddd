"""`align` and `alignfree`: a free body gets its frame at its centre of mass, along its principal axes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.description.eigen import diagonalize
from carom.description.pose import Pose, Vector3
from carom.description.stage import StageLight
from carom.description.transform import (
    Matrix3,
    compose,
    inverse,
    quaternion_from_matrix,
    rotation_matrix,
)
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.inertia import BodyInertia, Matrix
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel
from carom.native.products import dots, turned_tensor

_PRECISION, _MAX_ROTATIONS = 1e-16, 60
_EQUAL = 1e-12
"""Moments that differ by less stay in their order [kg m²]."""


def is_aligned(scope: Scope, element: Element) -> bool:
    """Whether a free joint wants the frame of its body moved: itself, or what the compiler says of all."""
    stated = scope.attributes(element).get("align", "auto")
    if stated not in ("true", "false", "auto"):
        raise scope.context.error(element, f"align={stated!r} must be true, false or auto")
    return stated == "true" or (stated == "auto" and scope.context.compiler.align_free)


def align(body: CompiledBody, model: CompiledModel) -> Pose | None:
    """Move the frame of a body, and keep all that it has in place; returns what leads from the new frame.

    As in MuJoCo, bodies with other bodies in them keep their frames, and nothing is returned.
    """
    if body.children or body.inertia.mass <= 0.0:
        return None
    inertial = _inertial_frame(body.inertia)
    back = inverse(inertial)
    body.pose = compose(body.pose, inertial)
    turn = _axes(body.inertia)
    body.inertia = BodyInertia(
        body.inertia.mass, np.zeros(3), turned_tensor(turn.T, body.inertia.tensor), np.eye(3)
    )
    body.visuals = [replace(it, frame=compose(back, it.frame)) for it in body.visuals]
    body.collisions = [replace(it, frame=compose(back, it.frame)) for it in body.collisions]
    body.fluids = [(fluid, compose(back, place)) for fluid, place in body.fluids]
    for name, site in model.sites.items():
        if site.body == body.name:
            model.sites[name] = replace(site, frame=compose(back, site.frame))
    for name, camera in model.cameras.items():
        if camera.body == body.name:
            model.cameras[name] = replace(camera, frame=compose(back, camera.frame))
    model.lights = [
        replace(it, light=_seen_from(back, it.light)) if it.body == body.name else it for it in model.lights
    ]
    return back


def _seen_from(back: Pose, light: StageLight) -> StageLight:
    position = compose(back, Pose(light.position)).position
    x, y, z = (
        float(it) for it in dots(np.array(rotation_matrix(back.orientation)), np.array(light.direction))
    )
    return replace(light, position=position, direction=(x, y, z))


def _inertial_frame(inertia: BodyInertia) -> Pose:
    x, y, z = (float(number) for number in inertia.centre)
    position: Vector3 = (x, y, z)
    rows: Matrix3 = tuple(tuple(float(number) for number in row) for row in _axes(inertia))  # pyright: ignore
    return Pose(position, quaternion_from_matrix(rows))


def _axes(inertia: BodyInertia) -> Matrix:
    """The principal axes as columns: those that are stated, or the greatest moment first."""
    if inertia.axes is not None:
        return inertia.axes
    rows = tuple((float(a), float(b), float(c)) for a, b, c in inertia.tensor)
    found, columns = diagonalize((rows[0], rows[1], rows[2]), _PRECISION, _MAX_ROTATIONS)
    moments, axes = list(found), np.array(columns)
    for first in (0, 1, 0):
        second = first + 1
        if moments[first] + _EQUAL < moments[second]:
            # A quarter turn about the third axis exchanges both.
            moments[first], moments[second] = moments[second], moments[first]
            axes[:, first], axes[:, second] = axes[:, second].copy(), -axes[:, first]
    return axes
