"""`<geom>`: shapes that collide and that are seen, and their mass."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot

from carom.description import ConvexHull, Geometry, Mesh, Pose, TriangleMesh, Visual
from carom.description.fluid import FluidEllipsoid
from carom.description.geometry import BY_MJCF, FLOOR
from carom.description.pose import Vector3
from carom.description.shapes.moments import MassShape
from carom.description.transform import compose, turn_of_z
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.inertia import GeomMass
from carom.formats.mjcf.compiled.looks.material import read_material
from carom.formats.mjcf.compiled.shapes.fitting import fitted
from carom.formats.mjcf.compiled.shapes.fluid import read_fluid
from carom.formats.mjcf.compiled.shapes.geom_types import SIZES, half_extents
from carom.formats.mjcf.compiled.shapes.hfield import read_hfield
from carom.formats.mjcf.compiled.shapes.meshes import MeshAsset, Meshes
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_DENSITY = 1000.0


@dataclass(frozen=True, slots=True)
class Geom:
    """A geom of a body.

    Attributes:
        name: Its name, or nothing.
        geometry: The shape that collides.
        frame: The pose of that shape in the body.
        visual: What is seen of it.
        mass: Its mass; None if it has none.
        group: The number of its group, for `inertiagrouprange`.
        kinds: Bits `contype` and `conaffinity`.
        is_paired: A `<pair>` lets it collide whatever its bits.
        fluid: The ellipsoid on which the fluid acts, and its pose in the body; None for none.
        is_mesh: It is a mesh, or fitted to one: MuJoCo's frame of it has the principal axes of that.
    """

    name: str
    geometry: Geometry
    frame: Pose
    visual: Visual
    mass: GeomMass | None
    group: int
    kinds: tuple[int, int]
    is_paired: bool = False
    fluid: tuple[FluidEllipsoid, Pose] | None = None
    is_mesh: bool = False


def read_geom(scope: Scope, element: Element, meshes: Meshes) -> Geom | None:
    """What a `<geom>` describes; None for kinds that are reported as left out. Raises `DescriptionError`."""
    context, attributes = scope.context, scope.attributes(element)
    kind = attributes.get("type", "sphere")
    if kind == "sphere" and "type" not in attributes and "mesh" in attributes:
        kind = "mesh"
    name = scope.name(element)
    if kind == "sdf":
        context.leave_out(element, "the shape is missing", "distance fields of plugins are not built")
        return None
    pose = scope.pose(element, attributes)
    mesh = meshes.find(context, element, attributes["mesh"]) if "mesh" in attributes else None
    size: Vector3 = (0.0, 0.0, 0.0)
    hull: Geometry | None = None
    seen: Geometry | None = None
    if kind == FLOOR.mjcf:
        # MuJoCo draws a plane without end where its size is 0.
        half = [*context.singles(element, "size", attributes.get("size", "")), 0.0, 0.0]
        seen_half = (max(half[0], 0.0), max(half[1], 0.0))
        geometry, mass = replace(FLOOR, size=seen_half), None
        size = (*seen_half, 0.0)
    elif kind == "hfield":
        geometry, raised = read_hfield(context, element, attributes)
        pose, mass = compose(pose, raised), None
    elif kind == "mesh":
        if mesh is None:
            raise context.error(element, "a geom of type mesh needs the name of a mesh")
        hull, seen = _geometries(mesh)
        geometry, mass = hull, _mass(scope, element, attributes, pose, mesh.mass)
    elif kind in SIZES:
        size, pose = _size_and_pose(scope, element, attributes, kind, pose, mesh)
        geometry = BY_MJCF[kind].of_sizes(*size)
        shell = context.flag(element, attributes, "shellinertia", False)
        shape = geometry.shell() if shell else geometry.solid()
        if shell and shape is None:
            context.leave_out(
                element,
                "its inertia is that of a solid",
                "shells that are ellipsoids are not built",
                "shellinertia",
            )
            shape = geometry.solid()
        mass = _mass(scope, element, attributes, pose, shape)
    else:
        raise context.error(element, f"unknown type of geom {shown(kind)}")
    group = int(context.number(element, attributes, "group", 0.0))
    return Geom(
        name,
        geometry,
        pose,
        Visual(
            seen or geometry,
            pose,
            name,
            read_material(context, element, attributes, half_extents(kind, size)),
            group=group,
        ),
        mass,
        group,
        (_bits(scope, element, attributes, "contype"), _bits(scope, element, attributes, "conaffinity")),
        fluid=read_fluid(context, element, attributes, kind, size, pose, mesh),
        is_mesh=mesh is not None or kind == "hfield",
    )


def _bits(scope: Scope, element: Element, attributes: Attributes, name: str) -> int:
    return int(scope.context.number(element, attributes, name, 1.0))


def _mass(
    scope: Scope, element: Element, attributes: Attributes, pose: Pose, shape: MassShape | None
) -> GeomMass | None:
    """The mass of a geom: stated, or by its density."""
    context = scope.context
    density = context.number(element, attributes, "density", _DENSITY)
    if shape is None:
        if "mass" in attributes or density == 0.0:
            return None
        context.leave_out(element, "it has no mass", "its mesh has no volume")
        return None
    mass = context.number(element, attributes, "mass", density * shape.measure)
    if mass < 0.0:
        if "mass" in attributes or density < 0.0:
            raise context.error(element, "mass and density must not be negative")
        raise context.error(element, 'the volume of its mesh is negative; inertia="convex" takes its hull')
    return GeomMass(mass, shape, pose) if mass > 0.0 else None


def _size_and_pose(
    scope: Scope, element: Element, attributes: Attributes, kind: str, pose: Pose, mesh: MeshAsset | None
) -> tuple[Vector3, Pose]:
    """Sizes as MJCF has them, and the pose of the shape in the body."""
    context = scope.context
    if mesh is not None:
        scale = context.number(element, attributes, "fitscale", 1.0)
        found = fitted(mesh, kind, by_bounds=context.compiler.fit_bounds)
        if found is None:
            raise context.error(element, "its mesh has no volume, so no shape can be fitted to it")
        (x, y, z), frame = found
        return (scale * x, scale * y, scale * z), compose(pose, frame)
    text = attributes.get("size", "")
    numbers = context.singles(element, "size", text)
    needed = SIZES[kind]
    if SIZES[kind] > 1 and "fromto" in attributes:
        own, half = frame_between(context, element, attributes["fromto"])
        pose = compose(scope.into, own)
        if numbers and needed == 2:
            numbers = [numbers[0], half]
        elif numbers:
            numbers = [numbers[0], numbers[1] if len(numbers) > 1 else numbers[0], half]
    if len(numbers) < needed or any(number <= 0.0 for number in numbers[:needed]):
        raise context.error(element, f"size={shown(text)}: a {kind} needs {needed} positive numbers")
    x, y, z = (*numbers[:needed], 0.0, 0.0)[:3]
    return (x, y, z), pose


def frame_between(context: CompiledContext, element: Element, text: str) -> tuple[Pose, float]:
    """A frame midway between two ends, its z axis from the second to the first, and half their distance."""
    ax, ay, az, bx, by, bz = context.numbers(element, "fromto", text, 6, 6)
    x, y, z = ax - bx, ay - by, az - bz
    length = hypot(x, y, z)
    if length == 0.0:
        raise context.error(element, "fromto: both ends are the same point")
    middle = (0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz))
    return Pose(middle, turn_of_z((x / length, y / length, z / length))), 0.5 * length


def _geometries(mesh: MeshAsset) -> tuple[Geometry, Geometry]:
    """The shape of a mesh that collides, its hull, and the one that is seen."""
    hull = ConvexHull(mesh.vertices, margin=0.0, keeps_all=True)
    if mesh.file is not None and mesh.file.suffix.lower() != ".msh":
        return hull, Mesh(mesh.file, mesh.scale)
    return hull, TriangleMesh(mesh.vertices, mesh.triangles) if len(mesh.triangles) else hull
