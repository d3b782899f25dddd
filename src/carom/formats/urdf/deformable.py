"""`<deformable>` and `<reduced_deformable>`: soft bodies, Bullet's extension of URDF."""

from __future__ import annotations

from pathlib import Path

from carom.description.deformable import Deformable, LameCoefficients, SpringCoefficients
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext
from carom.formats.robot.geometry import shape_file

_SUFFIXES = (".obj", ".vtk")
_DEFAULT_MARGIN = 0.02
_DEFAULT_FRICTION, _REDUCED_FRICTION = 1.0, 0.0
_REDUCED_MASS, _REDUCED_STIFFNESS = 1.0, 100.0
# Bending springs connect nodes that are this many edges apart.
_STRIDE = 2.0


def read_deformable(context: FileContext, element: Element) -> Deformable:
    """The soft body that a `<deformable>` or `<reduced_deformable>` describes; raises `DescriptionError`.

    Lengths are not scaled: the meshes are read later.
    """
    context.required(element, "name")
    reduced = element.tag == "reduced_deformable"
    visual = element.first("visual")
    if visual is None:
        raise context.error(element, "<visual> is missing")
    friction = _REDUCED_FRICTION if reduced else _DEFAULT_FRICTION
    collision = element.first("collision")
    springs = element.first("spring")
    return Deformable(
        visual=_mesh(context, visual),
        mass=context.child_value(element, "mass", _REDUCED_MASS) if reduced else _mass(context, element),
        margin=context.child_value(element, "collision_margin", _DEFAULT_MARGIN),
        friction=context.child_value(element, "friction", friction),
        simulated=None if collision is None else _mesh(context, collision),
        gravity_factor=1.0 if reduced else context.child_value(element, "gravity_factor", 1.0),
        springs=None if reduced or springs is None else _springs(context, springs),
        neo_hookean=None if reduced else _lame(context, element.first("neohookean")),
        corotated=None if reduced else _lame(context, element.first("corotated")),
        stiffness_scale=context.child_value(element, "stiffness_scale", _REDUCED_STIFFNESS)
        if reduced
        else None,
        mode_damping=context.child_value(element, "damping_coefficient", 0.0) if reduced else 0.0,
    )


def _mesh(context: FileContext, element: Element) -> Path:
    name = context.required(element, "filename")
    return shape_file(context, element, "filename", name, _SUFFIXES)


def _mass(context: FileContext, element: Element) -> float:
    inertial = element.first("inertial")
    if inertial is None or inertial.first("mass") is None:
        raise context.error(inertial or element, "<inertial> with a <mass> is missing")
    return context.value(*context.place(inertial, "mass"))


def _springs(context: FileContext, element: Element) -> SpringCoefficients:
    bending = context.value(element, "bending_stiffness", 0.0)
    if bending and context.value(element, "bending_stride", _STRIDE) != _STRIDE:
        context.warn(
            element, "bending springs connect nodes with a neighbour in common, as with bending_stride=2"
        )
    return SpringCoefficients(
        context.value(element, "elastic_stiffness"), context.value(element, "damping_stiffness"), bending
    )


def _lame(context: FileContext, element: Element | None) -> LameCoefficients | None:
    if element is None:
        return None
    return LameCoefficients(
        context.value(element, "mu"), context.value(element, "lambda"), context.value(element, "damping", 0.0)
    )
