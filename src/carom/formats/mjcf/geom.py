"""`<geom>`: a collision and visual shape, and its mass."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi
from pathlib import Path

import numpy as np

from carom.description import Collision, ContactParameters, ConvexHull, Geometry, Material, Mesh, Pose, Visual
from carom.description.geometry import BY_MJCF, FLOOR
from carom.description.pose import Vector3
from carom.description.transform import compose, turn_of_z
from carom.files.xml_element import Element
from carom.formats.mjcf.context import MjcfContext, single
from carom.formats.mjcf.defaults import Attributes
from carom.formats.mjcf.frames import read_pose
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown
from carom.formats.robot.geometry import MESH_SUFFIXES, check_suffix
from carom.native.trigonometry import cos, sin

_FRICTION = 0.5
_CONTACT_DIMENSIONS = "3"
_HULL_RINGS, _HULL_SECTORS = 9, 16
_HALF_A_TURN_ABOUT_Y = (0.0, -1.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Geom:
    """One shape of a body.

    Attributes:
        collision: Its collision shape.
        visual: Its visual shape.
        volume: [m³]; 0 for meshes and planes, as in PyBullet.
        middle: Midpoint of the ends given by `fromto`, where PyBullet puts the centre of mass; None without
            `fromto`.
    """

    collision: Collision
    visual: Visual
    volume: float
    middle: Vector3 | None


def read_geom(context: MjcfContext, element: Element, attributes: Attributes, into: Pose) -> Geom | None:
    """The shape of a `<geom>`; None, with a warning, where PyBullet too ignores the geom.

    `attributes` include defaults; `into` is the pose, in the link frame, of the frame in which its own pose
    is given. Raises `DescriptionError` if an attribute is missing or invalid.
    """
    kind = attributes.get("type", "mesh" if "mesh" in attributes else "sphere")
    pose = compose(into, read_pose(context, element, attributes, radians=True))
    ends = _ends(context, element, attributes) if has_ends(kind) else None
    shape = _shape(context, element, attributes, kind, ends)
    if shape is None:
        return None
    geometry, volume = shape
    frame, given_in = pose, None
    if ends is not None:
        frame = compose(pose, _between(ends))
        given_in = pose
    return Geom(
        Collision(
            geometry,
            frame,
            name=attributes.get("name", ""),
            group=context.parse_bits(element, "contype", attributes.get("contype", "1")),
            mask=context.parse_bits(element, "conaffinity", attributes.get("conaffinity", "1")),
            ends_frame=given_in,
            implicit=context.implicit,
        ),
        Visual(geometry, frame, attributes.get("name", ""), _material(context, element, attributes)),
        volume,
        None if ends is None else compose(into, Pose(_middle(ends))).position,
    )


def read_contact(context: MjcfContext, element: Element, defaults: Attributes) -> ContactParameters:
    """Contact parameters of a link with this geom.

    As in PyBullet, lateral friction is that of the geom itself, but rolling and spinning friction are those
    of its defaults.
    """
    attributes = layered(defaults, element.attributes)
    own = context.singles(element, "friction", attributes.get("friction", ""))
    inherited = context.singles(element, "friction", defaults.get("friction", ""))
    text = attributes.get("condim", _CONTACT_DIMENSIONS)
    dimensions = int(context.parse_number(element, "condim", text))
    spinning = inherited[1] if len(inherited) > 1 else 0.0
    rolling = inherited[2] if len(inherited) > 2 else 0.0
    return ContactParameters(
        lateral_friction=own[0] if own else _FRICTION,
        spinning_friction=spinning if dimensions > 3 else None,
        rolling_friction=rolling if dimensions > 4 else None,
    )


def _shape(
    context: MjcfContext,
    element: Element,
    attributes: Attributes,
    kind: str,
    ends: tuple[Vector3, Vector3] | None,
) -> tuple[Geometry, float] | None:
    """Shape and volume [m³]."""
    text = attributes.get("size", "")
    if kind == FLOOR.mjcf:
        return FLOOR, 0.0
    if kind == "ellipsoid":
        axes = context.triple(element, "size", text)
        _check_sizes(context, element, axes)
        return _ellipsoid(axes), 4.0 / 3.0 * pi * axes[0] * axes[1] * axes[2]
    if kind == "mesh":
        mesh = _mesh(context, element, attributes)
        return None if mesh is None else (mesh, 0.0)
    if kind not in BY_MJCF:
        context.warn(element, f"geoms of type {shown(kind)} are left out")
        return None
    sizes = _sizes(context, element, text, kind, ends)
    if sizes is None:
        return None
    geometry = BY_MJCF[kind].of_sizes(*sizes)
    return geometry, geometry.volume()


def _sizes(
    context: MjcfContext, element: Element, text: str, kind: str, ends: tuple[Vector3, Vector3] | None
) -> Vector3 | None:
    """The sizes of a geom; None, with a warning, for one that PyBullet leaves out."""
    count = BY_MJCF[kind].size_count
    if count == 1:
        # The one size that PyBullet does not round to single precision.
        words = text.split()
        radius = context.parse_number(element, "size", words[0]) if words else 1.0
        _check_sizes(context, element, [radius])
        return (radius, 0.0, 0.0)
    if count == 3:
        half = context.triple(element, "size", text) if text else (1.0, 1.0, 1.0)
        _check_sizes(context, element, half)
        return half
    sizes = context.singles(element, "size", text)
    _check_sizes(context, element, sizes)
    if not sizes:
        raise context.error(element, f"a {kind} needs a size")
    if ends is None and len(sizes) < 2:
        context.warn(element, f"a {kind} without fromto needs two sizes; it is left out, as in PyBullet")
        return None
    half_length = sizes[1] if ends is None else 0.5 * hypot(*(b - a for a, b in zip(*ends, strict=True)))
    return (sizes[0], half_length, 0.0)


def _check_sizes(context: MjcfContext, element: Element, sizes: tuple[float, ...] | list[float]) -> None:
    if any(size < 0.0 for size in sizes):
        raise context.error(element, f"size={shown(element.attributes.get('size', ''))} must not be negative")


def has_ends(kind: str) -> bool:
    """Whether files may state a geom of a type by its ends: one that has a length beside its radius."""
    return kind in BY_MJCF and BY_MJCF[kind].size_count == 2


def _ends(context: MjcfContext, element: Element, attributes: Attributes) -> tuple[Vector3, Vector3] | None:
    text = attributes.get("fromto")
    if text is None:
        return None
    numbers = context.singles(element, "fromto", text)
    if len(numbers) < 6:
        raise context.error(element, f"fromto={shown(text)} needs six numbers")
    return (numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5])


def _middle(ends: tuple[Vector3, Vector3]) -> Vector3:
    (ax, ay, az), (bx, by, bz) = ends
    return (0.5 * (ax + bx), 0.5 * (ay + by), 0.5 * (az + bz))


def _between(ends: tuple[Vector3, Vector3]) -> Pose:
    """A frame midway between two ends, its z axis pointing from the first to the second."""
    x, y, z = (b - a for a, b in zip(*ends, strict=True))
    length = hypot(x, y, z)
    if length * length <= 2.220446049250313e-16:
        return Pose(_middle(ends))
    if z == -length:
        # As in PyBullet; MuJoCo turns about the x axis.
        return Pose(_middle(ends), _HALF_A_TURN_ABOUT_Y)
    return Pose(_middle(ends), turn_of_z((x / length, y / length, z / length)))


def _ellipsoid(axes: Vector3) -> ConvexHull:
    """Points on an ellipsoid: rings of latitude and the poles."""
    points = [(0.0, 0.0, axes[2]), (0.0, 0.0, -axes[2])]
    for ring in range(1, _HULL_RINGS + 1):
        height = pi * ring / (_HULL_RINGS + 1)
        for sector in range(_HULL_SECTORS):
            angle = 2.0 * pi * (sector + 0.5 * (ring % 2)) / _HULL_SECTORS
            points.append(
                (
                    axes[0] * sin(height) * cos(angle),
                    axes[1] * sin(height) * sin(angle),
                    axes[2] * cos(height),
                )
            )
    return ConvexHull(np.array(points))


def _mesh(context: MjcfContext, element: Element, attributes: Attributes) -> Mesh | None:
    name = attributes.get("mesh", "")
    asset = context.assets.meshes.get(name)
    if asset is None:
        context.warn(element, f"there is no mesh {shown(name)}; the geom is left out, as in PyBullet")
        return None
    path = _mesh_file(context, asset)
    if path is None:
        context.warn(
            element, f"the file of mesh {shown(name)} was not found; the geom is left out, as in PyBullet"
        )
        return None
    scale = (1.0, 1.0, 1.0)
    if "scale" in asset.attributes:
        scale = context.triple(asset, "scale", asset.attributes["scale"])
    return Mesh(path, scale)


def _mesh_file(context: MjcfContext, asset: Element) -> Path | None:
    name = asset.attributes.get("file", "")
    check_suffix(context, asset, "file", name, MESH_SUFFIXES)
    directory = context.compiler.mesh_directory
    candidates = [directory + name]
    if directory and not directory.endswith("/"):
        candidates.append(f"{directory}/{name}")
    for candidate in candidates:
        path = context.find_file(candidate)
        if path is not None:
            return path
    return None


def _material(context: MjcfContext, element: Element, attributes: Attributes) -> Material:
    """The material of a geom: white, unless colours are read from the file."""
    white = Material(rgba=(1.0, 1.0, 1.0, 1.0), specular=(1.0, 1.0, 1.0))
    if not context.colours:
        return white
    text = attributes.get("rgba")
    if text is None:
        asset = context.assets.materials.get(attributes.get("material", ""))
        text = None if asset is None else asset.attributes.get("rgba")
    if text is None:
        return white
    components = context.parse_components(element, "rgba", text, (4,))
    if components is None:
        return white
    red, green, blue, opacity = map(single, components)
    return Material(text, rgba=(red, green, blue, opacity), specular=(1.0, 1.0, 1.0))
