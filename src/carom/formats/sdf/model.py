"""`<model>` as PyBullet reads it: robots from its links and joints, one for each tree of links."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Joint, Link, Pose, Robot
from carom.description.pose import IDENTITY
from carom.description.transform import compose
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.placed import PlacedRobot
from carom.formats.robot.context import shown
from carom.formats.robot.link import MASSLESS, read_link
from carom.formats.robot.tree import find_root
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.geometry import read_sdf_geometry
from carom.formats.sdf.joint import WORLD, read_sdf_joint
from carom.formats.sdf.looks import read_material

_WORDS = {"true": True, "false": False}
_IGNORED = {"model": "nested models are", "frame": "frames are", "plugin": "plugins are"}


def read_model(context: SdfContext, element: Element) -> list[PlacedRobot]:
    """The robots of a `<model>`, one for each link that has no parent; raises `DescriptionError`."""
    name = context.required(element, "name")
    for child in element.children:
        if child.tag in _IGNORED:
            context.warn(child, f"{_IGNORED[child.tag]} ignored")
    links, poses, joints, joint_elements = _read_parts(context, element)
    place, static = context.pose(element), _is_static(context, element)
    carried = {joint.child for joint in joints}
    roots = [index for index in range(len(links)) if index not in carried]
    if len(roots) <= 1:
        root = find_root(context, links, joints, joint_elements)
        # In PyBullet, the model's pose becomes that of its root link; the link's own pose is ignored.
        return [PlacedRobot(_robot(context, name, links, joints, root), place, static)]
    return [
        PlacedRobot(
            _part(context, name, links, joints, root, joint_elements), compose(place, poses[root]), static
        )
        for root in roots
    ]


def _read_parts(
    context: SdfContext, element: Element
) -> tuple[list[Link], list[Pose], list[Joint], list[Element]]:
    """Links, their poses and joints, as PyBullet reads them."""
    links, poses = _read_links(context, element)
    joint_elements = list(element.all("joint"))
    indices = {link.name: index for index, link in enumerate(links)}
    if WORLD not in indices and any(context.text(joint, "parent") == WORLD for joint in joint_elements):
        # The parent of a joint is the world itself.
        indices[WORLD] = len(links)
        links.append(Link(WORLD, inertial=MASSLESS))
        poses.append(IDENTITY)
    joints = [read_sdf_joint(context, joint, indices, poses) for joint in joint_elements]
    lines: dict[str, int] = {}
    for joint in joint_elements:
        context.refuse_duplicate(joint, joint.attributes["name"], lines)
    return links, poses, joints, joint_elements


def _read_links(context: SdfContext, model: Element) -> tuple[list[Link], list[Pose]]:
    links: list[Link] = []
    poses: list[Pose] = []
    lines: dict[str, int] = {}
    for element in model.all("link"):
        link = read_link(context, element, read_sdf_geometry, read_material)
        context.refuse_duplicate(element, link.name, lines)
        links.append(link)
        poses.append(context.pose(element))
    if not links:
        raise context.error(model, "there are no links")
    return links, poses


def _is_static(context: SdfContext, model: Element) -> bool:
    """Whether a model is fixed in the world, by `<static>`: 1, or if the context says so also `true`."""
    element = model.first("static")
    if element is None:
        return False
    if context.words_are_true and element.text.strip() in _WORDS:
        return _WORDS[element.text.strip()]
    try:
        return int(context.value(model, "static")) == 1
    except DescriptionError:
        context.warn(element, f"{shown(element.text.strip())} is read as 0, as in PyBullet; write 1")
        return False


def _part(
    context: SdfContext,
    name: str,
    links: list[Link],
    joints: list[Joint],
    root: int,
    joint_elements: list[Element],
) -> Robot:
    """The robot made from a root link and its descendants."""
    kept = {root}
    # Each round adds the links one joint farther out.
    while True:
        more = {joint.child for joint in joints if joint.parent in kept} - kept
        if not more:
            break
        kept |= more
    number = {link: place for place, link in enumerate(sorted(kept))}
    own = [index for index, joint in enumerate(joints) if joint.child in kept and joint.parent in kept]
    own_joints = [
        replace(joints[index], parent=number[joints[index].parent], child=number[joints[index].child])
        for index in own
    ]
    own_links = [links[index] for index in sorted(kept)]
    find_root(context, own_links, own_joints, [joint_elements[index] for index in own])
    return _robot(context, name, own_links, own_joints, number[root])


def _robot(context: SdfContext, name: str, links: list[Link], joints: list[Joint], root: int) -> Robot:
    return Robot(name, tuple(links), tuple(joints), root=root, source=context.file)
