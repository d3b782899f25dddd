"""Links and joints of a model and of the models inside it, as their author placed them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from carom.description import Joint, JointType, Link, Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose, inverse
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.robot.link import MASSLESS
from carom.formats.sdf.frames import WORLD, Frames
from carom.formats.sdf.gearboxes import GEARBOX, names_within, with_gearboxes
from carom.formats.sdf.joint_frames import Hinged, read_hinged
from carom.formats.sdf.tree import ModelTree, Part
from carom.formats.sdf.written_link import read_written_link


@dataclass(slots=True)
class Parts:
    """Links and joints of a model.

    Attributes:
        links: Those of the models inside it have names like `arm::hand`.
        poses: Frames of the links in that of the model.
        joints: Likewise; their frames are those of their child links.
        elements: The `<joint>` of each joint.
        fixed: Indices of links that cannot move.
        kinematic: Indices of links that are moved by users only.
        collide: Names of links that collide with others of their model.
        links_of: What states a link, the frames of its model, and its name.
        joints_of: What states a joint, the frames of its model, the prefix of names there, and the joint that
            moves its child link.
        gearboxes: Joints that tie others together, and the prefix of the names of what they tie.
    """

    links: list[Link] = field(default_factory=list)
    poses: list[Pose] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    elements: list[Element] = field(default_factory=list)
    fixed: set[int] = field(default_factory=set)
    kinematic: list[int] = field(default_factory=list)
    collide: set[str] = field(default_factory=set)
    links_of: list[tuple[Part, Frames, str]] = field(default_factory=list)
    joints_of: list[tuple[Part, Frames, str, Joint]] = field(default_factory=list)
    gearboxes: list[tuple[Part, str]] = field(default_factory=list)


def read_parts(tree: ModelTree, frames: Frames) -> Parts:
    """The links and joints of a model; raises `DescriptionError`."""
    parts = Parts()
    _add_links(parts, frames, "", IDENTITY, is_static=tree.static)
    if not parts.links:
        return parts
    if _is_held(tree) and WORLD not in {link.name for link in parts.links}:
        parts.fixed.add(len(parts.links))
        parts.links.append(Link(WORLD, inertial=MASSLESS))
        parts.poses.append(IDENTITY)
    _add_joints(parts, frames, "", IDENTITY)
    joints = with_gearboxes(parts.links, parts.poses, parts.joints, parts.gearboxes)
    # What is static does not move on its joints either.
    parts.joints = [_stiff(it) if it.child in parts.fixed else it for it in joints]
    return parts


def _stiff(joint: Joint) -> Joint:
    return Joint(joint.name, JointType.FIXED, joint.parent, joint.child, joint.frame)


def _is_held(tree: ModelTree) -> bool:
    """Whether a joint of a model or of one inside it connects it to the world."""
    ends = (part.context.text(part.element, "parent") for part in tree.of("joint"))
    return WORLD in ends or any(_is_held(model) for model in tree.models)


def _add_links(parts: Parts, frames: Frames, prefix: str, place: Pose, *, is_static: bool) -> None:
    tree = frames.tree
    tree.element.note()
    collides = tree.context.says(tree.element, "self_collide")
    for part in tree.of("link"):
        name = prefix + part.element.attributes["name"]
        in_model = frames.of(part)
        link = read_written_link(part.context, part.element, Placed(frames, part, in_model))
        if is_static:
            parts.fixed.add(len(parts.links))
        if part.context.says(part.element, "kinematic"):
            parts.kinematic.append(len(parts.links))
        if collides or part.context.says(part.element, "self_collide"):
            parts.collide.add(name)
        parts.links_of.append((part, frames, name))
        parts.links.append(replace(link, name=name))
        parts.poses.append(compose(place, in_model))
    for model in tree.models:
        inner = frames.inside(model)
        pose = compose(place, frames.of_model(model))
        _add_links(parts, inner, f"{prefix}{model.name}::", pose, is_static=is_static or model.static)


class Placed:
    """Poses of what a link has, in the frame of the link."""

    def __init__(self, frames: Frames, link: Part, in_model: Pose) -> None:
        self._frames = frames
        self._link = link
        self._in_model = in_model

    def __call__(self, element: Element) -> Pose:
        """The pose of a shape, a mass or a sensor of the link, which may be relative to any frame."""
        stated = element.first("pose")
        pose = self._link.context.pose(element)
        base = None if stated is None else stated.attributes.get("relative_to")
        if stated is None or not base or base == self._link.element.attributes.get("name"):
            return pose
        return compose(compose(inverse(self._in_model), self._frames.named(self._link, stated, base)), pose)


def _add_joints(parts: Parts, frames: Frames, prefix: str, place: Pose) -> None:
    tree = frames.tree
    # The world is the same in models inside others.
    whole = names_within(parts.links, "")
    world = {WORLD: whole[WORLD]} if WORLD in whole else {}
    names = world | names_within(parts.links, prefix)
    for part in tree.of("joint"):
        if part.element.attributes.get("type") == GEARBOX:
            parts.gearboxes.append((part, prefix))
            continue
        if tree.lacks and not _has_ends(part, frames, names):
            part.context.leave_out_all(part.element, "nothing is joined", "a model that it joins is missing")
            continue
        hinged = read_hinged(part, frames, names, parts.poses, prefix, place)
        _hang(parts, part.element, hinged)
        parts.joints_of.append((part, frames, prefix, parts.joints[-1]))
    for model in tree.models:
        inner = frames.inside(model)
        _add_joints(parts, inner, f"{prefix}{model.name}::", compose(place, frames.of_model(model)))


def _has_ends(part: Part, frames: Frames, names: dict[str, int]) -> bool:
    """Whether both links of a joint exist."""
    for tag in ("parent", "child"):
        name = part.context.text(part.element, tag) or ""
        try:
            if name not in names and frames.link(part, part.element, name) not in names:
                return False
        except DescriptionError:
            return False
    return True


def _hang(parts: Parts, element: Element, hinged: Hinged) -> None:
    """Add the joints of one `<joint>`, with massless links between them and its child link."""
    first = len(parts.links)
    child_name = parts.links[hinged.child].name
    joint_name = hinged.joints[0].name.rpartition("::")[2]
    between = [f"{child_name}@{joint_name}{'@' * number}" for number in range(len(hinged.joints) - 1)]
    parts.links += [Link(name, inertial=MASSLESS) for name in between]
    if hinged.child in parts.fixed:
        parts.fixed.update(range(first, first + len(between)))
    parts.poses += [hinged.pose] * len(between)
    chain = [hinged.parent, *range(first, first + len(between)), hinged.child]
    for joint, before, after in zip(hinged.joints, chain, chain[1:], strict=False):
        frame = compose(inverse(parts.poses[before]), parts.poses[after])
        if before >= first:
            frame = IDENTITY if after != hinged.child else hinged.offset
        parts.joints.append(replace(joint, parent=before, child=after, frame=frame))
        parts.elements.append(element)
