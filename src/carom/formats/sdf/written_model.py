"""`<model>` as its author means it: one robot for each tree of links."""

from __future__ import annotations

from dataclasses import replace

from carom.description import Joint, Link, Robot
from carom.description.transform import compose
from carom.formats.placed import PlacedRobot
from carom.formats.robot.tree import find_root
from carom.formats.sdf.actuation import read_actuators
from carom.formats.sdf.frames import Frames
from carom.formats.sdf.parts import Parts, read_parts
from carom.formats.sdf.scene import SdfModel
from carom.formats.sdf.sensors import read_sensors
from carom.formats.sdf.tree import ModelTree


def read_written_model(world: Frames, tree: ModelTree) -> SdfModel:
    """The robots of a model in a world, and what is on them; raises `DescriptionError`."""
    frames = world.inside(tree)
    parts = read_parts(tree, frames)
    if not parts.links:
        if not tree.lacks and not tree.static:
            raise tree.context.error(tree.element, "there are no links")
        tree.context.leave_out(tree.element, "none: it has no links", "nothing of it is left")
        return SdfModel()
    place = world.of_model(tree)
    carried = {joint.child for joint in parts.joints}
    roots = [index for index in range(len(parts.links)) if index not in carried]
    model = SdfModel(collide=parts.collide)
    read_sensors(parts, model)
    read_actuators(parts, frames, model)
    _report_kinematic(parts)
    for root in roots or [0]:
        kept = _kept(parts, root) if roots else set(range(len(parts.links)))
        links, joints = _numbered(parts, kept)
        elements = [
            element
            for element, joint in zip(parts.elements, parts.joints, strict=True)
            if joint.child in kept and joint.parent in kept
        ]
        own = find_root(tree.context, links, joints, elements)
        is_mocap = kept == {root} and root in parts.kinematic
        robot = Robot(
            tree.name,
            tuple(links),
            tuple(joints),
            root=own,
            source=tree.context.file,
            is_mocap=is_mocap,
        )
        pose = compose(place, parts.poses[root])
        model.robots.append(PlacedRobot(robot, pose, root in parts.fixed or robot.is_mocap))
    return model


def _report_kinematic(parts: Parts) -> None:
    """Report links that users alone should move, and that joints connect to others."""
    joined = {end for joint in parts.joints for end in (joint.parent, joint.child)}
    for index in parts.kinematic:
        if index in joined:
            part = parts.links_of[index][0]
            element = part.element.first("kinematic") or part.element
            part.context.leave_out(element, "the link moves as others do", "joints connect it to others")


def _kept(parts: Parts, root: int) -> set[int]:
    """A link and all links after it."""
    kept = {root}
    # Each round adds the links one joint farther out.
    while True:
        more = {joint.child for joint in parts.joints if joint.parent in kept} - kept
        if not more:
            return kept
        kept |= more


def _numbered(parts: Parts, kept: set[int]) -> tuple[list[Link], list[Joint]]:
    """Some links and the joints between them."""
    order = sorted(kept)
    number = {link: place for place, link in enumerate(order)}
    joints = [
        replace(joint, parent=number[joint.parent], child=number[joint.child])
        for joint in parts.joints
        if joint.child in kept and joint.parent in kept
    ]
    return [parts.links[index] for index in order], joints
