"""`<deformable>` and `<reduced_deformable>`: soft bodies, Bullet's extension of URDF."""

from __future__ import annotations

from pathlib import Path

from carom.description.deformable import Deformable, LameCoefficients, SpringCoefficients
from carom.formats.robot.geometry import shape_file
from carom.formats.urdf.context import UrdfContext
from carom.formats.xml_element import Element

_SUFFIXES = (".obj", ".vtk")
_DEFAULT_MARGIN = 0.02
_DEFAULT_FRICTION, _REDUCED_FRICTION = 1.0, 0.0
_REDUCED_MASS, _REDUCED_STIFFNESS = 1.0, 100.0
# Bending springs connect nodes that are this many edges apart.
_STRIDE = 2.0


def read_deformable(context: UrdfContext, element: Element) -> Deformable:
    """The soft body that a `<deformable>` or `<reduced_deformable>` describes.

    Lengths are not scaled: the meshes are read later.

    Raises:
        DescriptionError: The name, the mass or the mesh is missing, there is no such file, or a value is not
            a number.
    """
    context.required(element, "name")
    reduced = element.tag == "reduced_deformable"
    visual = element.first("visual")
    if visual is None:
        raise context.error(element, "<visual> is missing")
    collision = element.first("collision")
    springs = element.first("spring")
    return Deformable(
        visual=_mesh(context, visual),
        mass=_value(context, element, "mass", _REDUCED_MASS) if reduced else _mass(context, element),
        margin=_value(context, element, "collision_margin", _DEFAULT_MARGIN),
        friction=_value(context, element, "friction", _REDUCED_FRICTION if reduced else _DEFAULT_FRICTION),
        simulated=None if collision is None else _mesh(context, collision),
        gravity_factor=1.0 if reduced else _value(context, element, "gravity_factor", 1.0),
        springs=None if reduced or springs is None else _springs(context, springs),
        neo_hookean=None if reduced else _lame(context, element.first("neohookean")),
        corotated=None if reduced else _lame(context, element.first("corotated")),
        stiffness_scale=_value(context, element, "stiffness_scale", _REDUCED_STIFFNESS) if reduced else None,
        mode_damping=_value(context, element, "damping_coefficient", 0.0) if reduced else 0.0,
    )


def _mesh(context: UrdfContext, element: Element) -> Path:
    name = context.required(element, "filename")
    return shape_file(context, element, "filename", name, _SUFFIXES)


def _value(context: UrdfContext, element: Element, tag: str, default: float) -> float:
    child = element.first(tag)
    return default if child is None else context.value(child, "value")


def _mass(context: UrdfContext, element: Element) -> float:
    inertial = element.first("inertial")
    mass = None if inertial is None else inertial.first("mass")
    if mass is None:
        raise context.error(inertial or element, "<inertial> with a <mass> is missing")
    return context.value(mass, "value")


def _springs(context: UrdfContext, element: Element) -> SpringCoefficients:
    bending = context.value(element, "bending_stiffness", 0.0)
    if bending and context.value(element, "bending_stride", _STRIDE) != _STRIDE:
        context.warn(
            element, "bending springs connect nodes with a neighbour in common, as with bending_stride=2"
        )
    return SpringCoefficients(
        context.value(element, "elastic_stiffness"), context.value(element, "damping_stiffness"), bending
    )


def _lame(context: UrdfContext, element: Element | None) -> LameCoefficients | None:
    if element is None:
        return None
    return LameCoefficients(
        context.value(element, "mu"), context.value(element, "lambda"), context.value(element, "damping", 0.0)
    )
