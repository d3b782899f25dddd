"""`<body>`: the links and joints that PyBullet makes from it.

The joints of a body form a chain: the child of each is a massless link of its own, and a fixed joint connects
the last of these to the body. For a root body with joints, the chain begins at one more massless link, which
is fixed in the world; a root body without joints floats.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from carom.description import (
    Collision,
    ContactParameters,
    Inertial,
    Joint,
    JointType,
    Link,
    Pose,
    Robot,
    Visual,
)
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import compose, inverse
from carom.files.xml_element import Element
from carom.formats.mjcf.context import MjcfContext
from carom.formats.mjcf.defaults import Attributes, class_defaults, limits_left_out
from carom.formats.mjcf.frames import read_pose
from carom.formats.mjcf.geom import read_contact, read_geom
from carom.formats.mjcf.joint import FREE, joint_position, read_joint
from carom.formats.placed import PlacedRobot
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown
from carom.formats.robot.link import MASSLESS

_DENSITY = 1000.0
"""Density of every geom [kg/m³], as in PyBullet."""

_NOTHING = ContactParameters()
_UNNAMED_GEOM = "anonymous"
_LEFT_OUT = ("light", "camera", "site", "freejoint", "composite", "flexcomp", "plugin")


@dataclass(frozen=True, slots=True)
class Scope:
    """Settings that an element takes from the elements that enclose it.

    Attributes:
        child_class: Class of defaults that the enclosing bodies set for it.
        into: Pose, in the enclosing body, of the frame in which its own pose is given: that of enclosing
            `<frame>` elements, or of the world where poses are global.
    """

    child_class: str | None = None
    into: Pose = IDENTITY


@dataclass(slots=True)
class _Content:
    """The contents of a body that have been read so far."""

    frame: Pose = IDENTITY
    mass: float | None = None
    tensor: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    volume: float = 0.0
    collisions: list[Collision] = field(default_factory=list)
    visuals: list[Visual] = field(default_factory=list)
    contact: ContactParameters = _NOTHING


class ModelReader:
    """Makes one robot, with the name of all robots of the file, from a body or geom of the world.

    `number` is that of models in the file before it.
    """

    def __init__(self, context: MjcfContext, number: int, name: str) -> None:
        self.context = context
        self.number = number
        self.name = name
        self.links: list[Link] = []
        self.joints: list[Joint] = []
        self.lines: dict[str, int] = {}

    def read_body(self, element: Element, scope: Scope) -> PlacedRobot:
        """The robot whose root is this `<body>` of the world."""
        pose = self._read_body(element, scope, None)
        root = next(index for index in range(len(self.links)) if all(j.child != index for j in self.joints))
        # PyBullet puts the inertial frame at the pose that the file gives for the body's frame.
        place = compose(pose, inverse(self.links[root].inertial.frame)) if root == 0 else IDENTITY
        return PlacedRobot(self._robot(root), place)

    def read_world_geom(self, element: Element, scope: Scope) -> PlacedRobot:
        """The robot made from a `<geom>` of the world itself."""
        context = self.context
        defaults = class_defaults(context, element, scope.child_class)
        geom = read_geom(context, element, layered(defaults, element.attributes), scope.into)
        name = element.attributes.get("name", _UNNAMED_GEOM)
        link = Link(name, MASSLESS, contact=read_contact(context, element, defaults))
        if geom is not None:
            link = replace(link, collisions=(geom.collision,), visuals=(geom.visual,))
        self.links.append(link)
        return PlacedRobot(self._robot(0))

    def _read_body(self, element: Element, scope: Scope, parent: int | None) -> Pose:
        """Read a body and the bodies in it, and return its pose in its parent."""
        context = self.context
        body = self._add_link(element, element.attributes.get("name"))
        if "name" not in element.attributes:
            context.next_number()
        child_class = element.attributes.get("childclass", scope.child_class)
        defaults = class_defaults(context, element, scope.child_class)
        pose = read_pose(context, element, self._placing(layered(defaults, element.attributes), element))
        # Poses of its contents are given in the body's frame, or in the world frame if all poses are.
        inner = Scope(child_class, inverse(pose) if context.compiler.global_frames else IDENTITY)
        own = compose(scope.into, pose)
        frame, carrier = own, parent
        first_joint: Pose | None = None
        content = _Content()
        for child, within in _without_frames(context, element, inner):
            has_defaults = child.tag in ("joint", "geom")
            attributes_of = class_defaults(context, child, within.child_class) if has_defaults else {}
            if child.tag == "joint":
                attributes_of = limits_left_out(context, child, within.child_class, attributes_of)
            attributes = layered(attributes_of, child.attributes)
            if child.tag == "joint":
                kind = attributes.get("type")
                if kind == FREE and parent is None and carrier is None:
                    continue
                if carrier is None:
                    carrier = self._add_link(child, None)
                position = _moved(within.into, joint_position(context, child, attributes))
                place = Pose(position)
                moving = self._add_link(child, None)
                joint = read_joint(
                    context,
                    child,
                    attributes,
                    parent=carrier,
                    child=moving,
                    frame=compose(own if first_joint is None else inverse(first_joint), place),
                    into=within.into,
                )
                self._add_joint(child, joint, child.attributes.get("name"), moving)
                if first_joint is None:
                    # As in PyBullet, only the first joint determines where the body is.
                    first_joint = place
                    frame = inverse(place)
                carrier = moving
            elif child.tag == "geom":
                self._add_geom(child, attributes_of, within, content)
            elif child.tag == "inertial":
                self._read_inertial(child, within, content)
            elif child.tag == "body":
                self._read_body(child, within, body)
            elif child.tag not in _LEFT_OUT:
                context.warn(child, "left out")
        if carrier is not None:
            fixed = Joint("", JointType.FIXED, carrier, body, frame)
            self._add_joint(element, fixed, None, carrier)
        mass = _DENSITY * content.volume if content.mass is None else content.mass
        self.links[body] = replace(
            self.links[body],
            inertial=Inertial(mass, content.frame, content.tensor),
            collisions=tuple(content.collisions),
            visuals=tuple(content.visuals),
            contact=content.contact,
        )
        return own

    def _placing(self, attributes: Attributes, element: Element) -> Attributes:
        """The attributes that determine the pose of a body."""
        if self.context.as_mujoco or "axisangle" not in attributes:
            return attributes
        self.context.warn(element, "axisangle does not turn bodies in PyBullet; left out")
        return {name: text for name, text in attributes.items() if name != "axisangle"}

    def _add_link(self, element: Element, name: str | None) -> int:
        """Add a link, with a generated name if it has none, and return its index."""
        index = len(self.links)
        name = name or f"link{self.number}_{index}"
        self.context.refuse_duplicate(element, name, self.lines)
        self.links.append(Link(name, MASSLESS))
        return index

    def _add_joint(self, element: Element, joint: Joint, name: str | None, link: int) -> None:
        if name is None:
            number = self.context.next_number()
            is_made_up = joint.type is JointType.FIXED and element.tag == "body"
            name = f"jointfix_{number}_{link}" if is_made_up else f"joint{number}_{link}_{len(self.joints)}"
        elif any(other.name == name for other in self.joints):
            raise self.context.error(element, f"the name {shown(name)} is taken already")
        self.joints.append(replace(joint, name=name))

    def _add_geom(self, element: Element, defaults: Attributes, scope: Scope, content: _Content) -> None:
        content.contact = _with_earlier(read_contact(self.context, element, defaults), content.contact)
        geom = read_geom(self.context, element, layered(defaults, element.attributes), scope.into)
        # The last geom determines the centre of mass, unless an `<inertial>` came before it.
        if content.mass is None:
            middle = (0.0, 0.0, 0.0) if geom is None or geom.middle is None else geom.middle
            content.frame = replace(content.frame, position=middle)
        if geom is not None:
            content.volume += geom.volume
            content.collisions.append(geom.collision)
            content.visuals.append(geom.visual)

    def _read_inertial(self, element: Element, scope: Scope, content: _Content) -> None:
        context = self.context
        attributes = element.attributes
        pose = compose(scope.into, read_pose(context, element, attributes))
        content.frame = Pose(
            pose.position if "pos" in attributes else content.frame.position, pose.orientation
        )
        content.mass = context.non_negative(element, "mass") if "mass" in attributes else 0.0
        if context.compiler.inertia_from_geoms:
            return
        if "diaginertia" in attributes:
            x, y, z = context.triple(element, "diaginertia", attributes["diaginertia"])
            content.tensor = (x, 0.0, 0.0, y, 0.0, z)
        elif "fullinertia" in attributes:
            numbers = context.singles(element, "fullinertia", attributes["fullinertia"])
            if len(numbers) != 6:
                raise context.error(element, "fullinertia needs six numbers")
            xx, yy, zz, xy, xz, yz = numbers
            content.tensor = (xx, xy, xz, yy, yz, zz)

    def _robot(self, root: int) -> Robot:
        """The robot, its links in PyBullet's order: all children of a link before any grandchild."""
        children: dict[int, list[int]] = {}
        for joint in self.joints:
            children.setdefault(joint.parent, []).append(joint.child)
        order = [root]
        pending = [root]
        while pending:
            below = children.get(pending.pop(), [])
            order += below
            pending.extend(reversed(below))
        place = {link: index for index, link in enumerate(order)}
        joints = tuple(
            replace(joint, parent=place[joint.parent], child=place[joint.child]) for joint in self.joints
        )
        return Robot(self.name, tuple(self.links[link] for link in order), joints, source=self.context.file)


def _with_earlier(contact: ContactParameters, earlier: ContactParameters) -> ContactParameters:
    """Contact parameters of a body's last geom, plus kinds of friction that only earlier geoms state."""
    own = {name: getattr(contact, name) for name in ("spinning_friction", "rolling_friction")}
    kept = {name: getattr(earlier, name) for name, value in own.items() if value is None}
    return replace(contact, **kept)


def _without_frames(context: MjcfContext, parent: Element, scope: Scope) -> Iterator[tuple[Element, Scope]]:
    """The elements of a body or of the world, those in `<frame>` included, and their scopes."""
    for child in parent.children:
        if child.tag == "frame":
            child_class = child.attributes.get("childclass", scope.child_class)
            into = compose(scope.into, read_pose(context, child, child.attributes))
            yield from _without_frames(context, child, Scope(child_class, into))
        else:
            yield child, scope


def world_elements(context: MjcfContext, world: Element) -> Iterator[tuple[Element, Scope]]:
    """The bodies, geoms and so on of a `<worldbody>`, and their scopes."""
    return _without_frames(context, world, Scope())


def _moved(pose: Pose, point: Vector3) -> Vector3:
    return compose(pose, Pose(point)).position
