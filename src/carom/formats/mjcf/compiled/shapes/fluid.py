"""`fluidshape` of a `<geom>`: the ellipsoid on which the fluid acts."""

from __future__ import annotations

from carom.description.fluid import FluidEllipsoid
from carom.description.pose import Pose, Vector3
from carom.description.transform import compose
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.shapes.fitting import reach
from carom.formats.mjcf.compiled.shapes.geom_types import half_extents
from carom.formats.mjcf.compiled.shapes.meshes import MeshAsset
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_COEFFICIENTS = (0.5, 0.25, 1.5, 1.0, 1.0)
_ELLIPSOID, _NONE = "ellipsoid", "none"


def read_fluid(
    context: CompiledContext,
    element: Element,
    attributes: Attributes,
    kind: str,
    size: Vector3,
    pose: Pose,
    mesh: MeshAsset | None,
) -> tuple[FluidEllipsoid, Pose] | None:
    """The ellipsoid of a geom, and its pose in the body; None if it has none.

    Args:
        context: The reading of the file.
        element: The geom.
        attributes: Its attributes with defaults.
        kind: Its type.
        size: Its sizes, as MJCF states them [m]; any for a mesh.
        pose: Its pose in the body.
        mesh: The mesh of a geom of that type.

    Raises:
        DescriptionError: An attribute is not one that MJCF knows.
    """
    shape = attributes.get("fluidshape", _NONE)
    stated = context.numbers(element, "fluidcoef", attributes.get("fluidcoef", ""), 0, len(_COEFFICIENTS))
    if shape not in (_NONE, _ELLIPSOID):
        raise context.error(element, f"fluidshape={shown(shape)} must be none or ellipsoid")
    if shape == _NONE:
        return None
    if kind in ("plane", "hfield"):
        context.leave_out(element, "no fluid acts on it", f"a {kind} is no ellipsoid", "fluidshape")
        return None
    if kind == "mesh":
        found = None if mesh is None else reach(mesh)
        if found is None:
            context.leave_out(element, "no fluid acts on it", "its mesh has no volume", "fluidshape")
            return None
        size, frame = found
        pose = compose(pose, frame)
    blunt, slender, angular, kutta, magnus = (*stated, *_COEFFICIENTS[len(stated) :])
    axes = half_extents(kind, size)
    return FluidEllipsoid(axes, blunt, slender, angular, kutta, magnus), pose
