"""Descriptions as robots, written as URDF or USD, which know links and joints."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields, replace
from pathlib import Path

import numpy as np

from carom.description import (
    Collision,
    ContactParameters,
    ConvexHull,
    Geometry,
    Joint,
    Link,
    Mesh,
    Robot,
    TriangleMesh,
    Visual,
)
from carom.description.joint import BALL_TYPES, UNLIMITED, Mimic
from carom.editing.elements import bodies
from carom.editing.keys import joints_of
from carom.editing.losses import Losses
from carom.editing.masses import compiled
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.kinds import USD_SUFFIXES
from carom.formats.mjcf.compiled.model import CompiledModel
from carom.formats.mjcf.rules import MJCF_RULES
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import Ignored
from carom.formats.search import AssetSearch
from carom.formats.urdf_writer import urdf_text
from carom.geometry.hull import hull_triangles
from carom.meshes.reader import read_mesh
from carom.writing import write_text

_NONE_IN_URDF = "URDF has none"
_WORLD = "world"
_OF_JOINTS = ("solreflimit", "solimplimit", "solreffriction", "solimpfriction", "margin", "springdamper")
_OF_GEOMS = ("solref", "solimp", "solmix", "margin", "gap", "priority")
_ALL, _NONE = ("1", "1"), ("0", "0")
_HIDDEN = ("3", "4", "5")
"""Groups of geoms that are not shown."""


def write_robot(
    root: Element, source: Path, search: AssetSearch, path: Path, model: str | None
) -> list[Ignored]:
    """Write one robot of a description as URDF or USD; gives what is lost.

    Raises:
        DescriptionError: Something in the description is wrong, or several robots fit.
        OSError: The file cannot be written.
    """
    cursor = Cursor(MJCF_RULES)
    found = compiled(root, source, search, cursor)
    chosen = choose(source, found.robots, model)
    losses = Losses(source)
    others = [it for it in found.robots if it is not chosen]
    if others:
        listed = ", ".join(it.robot.name for it in others)
        losses.add("body of the world", f"these are missing: {listed}", "a file has one robot")
    if path.suffix.lower() in USD_SUFFIXES:
        from carom.formats.usd.writer import write_usd

        _count(root, found, losses, "the stage has bodies and joints", couplings=True)
        lost = write_usd(chosen.robot, path, fixed_base=chosen.fixed_base)
        return [*cursor.ignored(), *losses.list(), *lost]
    robot = _for_urdf(root, found, chosen, losses)
    robot = replace(robot, links=tuple(_with_files(_faceted(link, losses), path) for link in robot.links))
    write_text(path, urdf_text(robot, path.absolute().parent))
    return [*cursor.ignored(), *losses.list()]


def choose(source: Path, placed: list[PlacedRobot], model: str | None) -> PlacedRobot:
    """The robot of a name, of a root with this name, or of this number; raises `DescriptionError`.

    Shapes of the world are a robot as well, which counts only where it is the only one or is named.
    """
    if not placed:
        raise DescriptionError("it holds no robot", file=source)
    moving = [it for it in placed if it.robot.name != _WORLD] if model is None else placed
    matching = [
        it
        for index, it in enumerate(placed)
        if it in (moving or placed) and model in (None, str(index), it.robot.name, root_name(it.robot))
    ]
    if len(matching) != 1:
        listed = ", ".join(f"{i} {it.robot.name} ({root_name(it.robot)})" for i, it in enumerate(placed))
        problem = "several robots fit" if matching else f"there is no robot {model!r}"
        raise DescriptionError(f"{problem}; it holds {listed}", file=source)
    return matching[0]


def root_name(robot: Robot) -> str:
    """The name of the root link of a robot."""
    return robot.links[robot.root].name


def held(chosen: PlacedRobot) -> Robot:
    """The robot, without mass in its base if that is fixed."""
    robot = chosen.robot
    if not chosen.fixed_base:
        return robot
    root = robot.links[robot.root]
    links = list(robot.links)
    links[robot.root] = replace(root, inertial=replace(root.inertial, mass=0.0))
    return replace(robot, links=tuple(links))


def _count(root: Element, model: CompiledModel, losses: Losses, reason: str, *, couplings: bool) -> None:
    """Note what robots do not have."""
    counts = {
        "actuator": len(model.actuators),
        "sensor": len(model.sensors),
        "equality": len(model.connections)
        + len(model.tendon_couplings)
        + (len(model.couplings) if couplings else 0),
        "tendon": sum(not name.endswith("@limit") for name in model.tendons),
        "site": len(model.sites),
        "camera": len(model.cameras),
        "keyframe": len(model.keyframes),
        "contact/pair": len(model.paired),
        "contact/exclude": sum(len(list(it.all("exclude"))) for it in root.all("contact")),
        "option": sum(bool(it.attributes or it.children) for it in root.all("option")),
    }
    for element, count in counts.items():
        for _ in range(count):
            losses.add(element, "it is not in the file", reason)


def _for_urdf(root: Element, model: CompiledModel, chosen: PlacedRobot, losses: Losses) -> Robot:
    """A robot with what URDF can say of it and of the couplings of its joints; all else is noted."""
    robot = held(chosen)
    shapes = {body.attributes["name"]: list(body.all("geom")) for body in bodies(root)}
    _note_softness(robot, root, shapes, losses)
    _count(root, model, losses, _NONE_IN_URDF, couplings=False)
    if chosen.pose.position != (0.0, 0.0, 0.0) or chosen.pose.orientation != (0.0, 0.0, 0.0, 1.0):
        losses.add("body", "it is at the origin", "a URDF file has no pose in the world", "pos", "quat")
    base = chosen.robot.links[chosen.robot.root]
    if chosen.fixed_base and base.inertial.mass:
        losses.add(
            "body/inertial", "none while it is fixed: a base without mass is fixed", _NONE_IN_URDF, "mass"
        )
    names = {joint.name for joint in robot.joints}
    mimics: dict[str, Mimic] = {}
    for coupling in model.couplings:
        constant, first, *higher = coupling.coefficients
        if coupling.follower not in names:
            continue
        if coupling.leader is None or any(higher) or not coupling.enabled or coupling.follower in mimics:
            losses.add(
                "equality/joint", "its joints are not coupled", "URDF has couplings that are lines and hold"
            )
            continue
        mimics[coupling.follower] = Mimic(coupling.leader, first, constant)
    joints = [replace(joint_for_urdf(joint, losses), mimic=mimics.get(joint.name)) for joint in robot.joints]
    for joint in robot.joints:
        if model.starts.get(joint.name):
            losses.add("joint", "it starts at position 0", _NONE_IN_URDF, "ref")
        if f"{joint.name}@limit" in model.tendons:
            losses.add("joint", "it has no limit", _NONE_IN_URDF, "range")
    links = [_link(link, shapes.get(link.name, []), losses) for link in robot.links]
    terms = {
        "damping": robot.base_damping, "armature": robot.base_armature, "stiffness": robot.base_stiffness,
    }  # fmt: skip
    for name, value in terms.items():
        if value:
            losses.add("joint", "the base moves freely", _NONE_IN_URDF, name)
    return replace(robot, joints=tuple(joints), links=tuple(links), actuators=())


def joint_for_urdf(joint: Joint, losses: Losses) -> Joint:
    """A joint as URDF can say it; what is lost is noted."""
    for name in ("armature", "stiffness"):
        if getattr(joint, name):
            consequence = "it moves as if it were 0"
            losses.add("joint", consequence, _NONE_IN_URDF, name)
    if joint.type in BALL_TYPES:
        losses.add("joint", "only PyBullet and Carom read it", "spherical joints are theirs", "type")
    limit = joint.limit
    if joint.type in UNLIMITED and limit.lower > limit.upper:
        return replace(joint, type=UNLIMITED[joint.type])
    return joint


def _note_softness(robot: Robot, root: Element, shapes: dict[str, list[Element]], losses: Losses) -> None:
    """Note how constraints of a robot yield, where something else than usual is stated."""
    joints = {joint.name for joint in robot.joints}
    stated = [(it, _OF_JOINTS) for it in joints_of(root) if it.attributes.get("name") in joints]
    stated += [(it, _OF_GEOMS) for link in robot.links for it in shapes.get(link.name, [])]
    for element, names in stated:
        found = [name for name in names if name in element.attributes]
        if found:
            losses.add(element.tag, "its constraints are rigid", _NONE_IN_URDF, *found, of=element)


def _link(link: Link, shapes: list[Element], losses: Losses) -> Link:
    """A link as URDF can say it; `shapes` are the geoms of its body."""
    if link.gravity_compensation:
        losses.add("body", "all its weight counts", _NONE_IN_URDF, "gravcomp")
    if link.fluid is not None:
        losses.add("geom", "fluids see the box of its inertia", _NONE_IN_URDF, "fluidshape")
    collisions = link.collisions
    if all(_bits(it) in (_ALL, _NONE) for it in shapes):
        # All that collides does with all.
        collisions = tuple(replace(it, group=None, mask=None) for it in collisions)
    elif collisions:
        losses.add("geom", "only Bullet and Carom read its bits", "URDF has none", "contype", "conaffinity")
    visuals = link.visuals
    if len(visuals) == len(shapes):
        # Those that windows do not show are there to collide.
        seen = [it.attributes.get("group", "0") not in _HIDDEN for it in shapes]
        visuals = tuple(it for it, is_seen in zip(visuals, seen, strict=True) if is_seen)
    return with_one_contact(replace(link, collisions=collisions, visuals=visuals), losses)


def with_one_contact(link: Link, losses: Losses) -> Link:
    """A link whose shapes all touch as it does: URDF has one `<contact>` a link.

    If its shapes touch in one way, that is the way of the link.
    """
    stated = [it.contact or link.contact for it in link.collisions]
    if any(it.surface_motion is not None for it in stated):
        losses.add("geom", "its surface does not move", _NONE_IN_URDF, "surfacevel")
    of_shapes = [_contact_of_urdf(it) for it in stated]
    own = _contact_of_urdf(link.contact)
    contact = own if not of_shapes or own in of_shapes else of_shapes[0]
    differing = sorted(
        {
            field.name
            for other in of_shapes
            for field in fields(other)
            if getattr(other, field.name) != getattr(contact, field.name)
        }
    )
    if differing:
        losses.add(
            "collision/contact",
            f"all shapes of {link.name!r} touch as one of them",
            "URDF has one <contact> a link",
            *differing,
        )
    contact = replace(contact, inertia_scaling=link.contact.inertia_scaling)
    return replace(
        link, contact=contact, collisions=tuple(replace(it, contact=None) for it in link.collisions)
    )


def _contact_of_urdf(contact: ContactParameters) -> ContactParameters:
    """What URDF can say of contact parameters."""
    return replace(contact.without_rank(), compliance=None, inertia_scaling=None, surface_motion=None)


def _bits(geom: Element) -> tuple[str, str]:
    return (geom.attributes.get("contype", "1"), geom.attributes.get("conaffinity", "1"))


def _faceted(link: Link, losses: Losses) -> Link:
    """A link with the facets of shapes that URDF has not, such as ellipsoids, in their place."""

    def hull(geometry: Geometry) -> Geometry:
        facets = None if geometry.tag else geometry.facets()
        if facets is None:
            return geometry
        losses.add("shape", "its facets are in its place, by their hull", "URDF has none", "geometry")
        return ConvexHull(facets.points, margin=0.0)

    collisions = tuple(replace(it, geometry=hull(it.geometry)) for it in link.collisions)
    visuals = tuple(replace(it, geometry=hull(it.geometry)) for it in link.visuals)
    return replace(link, collisions=collisions, visuals=visuals)


def _with_files(link: Link, path: Path) -> Link:
    """A link whose meshes are in files: those they are from, or new ones beside the file at `path`."""
    stated = [it.geometry for it in link.visuals if isinstance(it.geometry, Mesh)]
    collisions = [
        replace(it, geometry=_file(it, stated, path, f"{link.name}_{number}"))
        if isinstance(it.geometry, (ConvexHull, TriangleMesh))
        else it
        for number, it in enumerate(link.collisions)
    ]
    visuals = [
        replace(it, geometry=_file(it, stated, path, f"{link.name}_seen_{number}"))
        if isinstance(it.geometry, (ConvexHull, TriangleMesh))
        else it
        for number, it in enumerate(link.visuals)
    ]
    return replace(link, collisions=tuple(collisions), visuals=tuple(visuals))


def _file(shape: Collision | Visual, stated: Iterable[Mesh], path: Path, name: str) -> Mesh:
    """The mesh of a shape in a file: one of those stated if it has the same corners, or a new one."""
    geometry = shape.geometry
    if isinstance(geometry, ConvexHull):
        points = np.asarray(geometry.points)
        for mesh in stated:
            parts = read_mesh(mesh.path, by_ears=True)
            corners = np.concatenate([part.vertices for part in parts]) * mesh.scale
            if corners.shape == points.shape and np.array_equal(corners, points):
                return mesh
        vertices, triangles = hull_triangles(points)
    else:
        assert isinstance(geometry, TriangleMesh), "others need no file"
        vertices, triangles = geometry.vertices, geometry.triangles
    folder = path.absolute().parent / f"{path.stem}_meshes"
    folder.mkdir(exist_ok=True)
    file = folder / f"{_plain(name)}.obj"
    write_text(file, _obj(vertices.tolist(), triangles.tolist()))
    return Mesh(file)


def _obj(vertices: list[list[float]], triangles: list[list[int]]) -> str:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    return "\n".join([*lines, ""])


def _plain(name: str) -> str:
    """A name as part of that of a file."""
    return "".join(letter if letter.isalnum() or letter in "-_" else "_" for letter in name)
