"""`<joint type="gearbox">`: two joints of one body that turn together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from carom.description import Joint, JointType, Link, Mimic, Pose
from carom.description.joint import HINGES
from carom.description.pose import Vector3
from carom.description.transform import dot, rotate
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.tree import Part

GEARBOX = "gearbox"


def names_within(links: Sequence[Link], prefix: str) -> dict[str, int]:
    """Indices of the links of a model by their names in it; those of the whole file begin with a prefix."""
    return {
        link.name[len(prefix) :]: index for index, link in enumerate(links) if link.name.startswith(prefix)
    }


def with_gearboxes(
    links: Sequence[Link],
    poses: Sequence[Pose],
    joints: Sequence[Joint],
    gearboxes: Sequence[tuple[Part, str]],
) -> list[Joint]:
    """The joints, those of them that gearboxes tie to others as their followers.

    Source: SDFormat specification, `<gearbox_ratio>`: the angle of the child link from the reference body is
    minus the ratio times that of the parent link. `poses` are those of the links in the frame of the model.

    Raises:
        DescriptionError: A gearbox lacks its reference body, or names a link that does not exist.
    """
    changed = list(joints)
    # A joint that is not at the origin of its link carries it by one without mass.
    carried = {it.parent: it.child for it in joints if it.type is JointType.FIXED and "@" in it.name}
    for part, prefix in gearboxes:
        context, element = part.context, part.element
        names = names_within(links, prefix)
        ends = [_end(context, element, tag, names) for tag in ("gearbox_reference_body", "parent", "child")]
        ratio = context.value(element, "gearbox_ratio", 1.0)
        leader, follower = (_joint_between(changed, carried, ends[0], end) for end in ends[1:])
        if leader is None or follower is None or leader == follower:
            reason = "its parent and child do not each turn on the reference body by a joint of their own"
            context.leave_out(element, "joints are not geared", reason, "type")
            continue
        signs = [
            _turn(changed[place], ends[0], poses, _axis(context, element, tag, changed[place], poses))
            for place, tag in ((leader, "axis"), (follower, "axis2"))
        ]
        factor = -ratio * signs[0] * signs[1]
        changed[follower] = replace(changed[follower], mimic=Mimic(changed[leader].name, factor))
    return changed


def _end(context: SdfContext, element: Element, tag: str, names: dict[str, int]) -> int:
    name = context.text(element, tag)
    if name is None:
        raise context.error(element, f"<{tag}> is missing")
    if name not in names:
        raise context.error(element.first(tag) or element, f"there is no link {shown(name)}")
    return names[name]


def _joint_between(joints: Sequence[Joint], carried: dict[int, int], a: int, b: int) -> int | None:
    """The joint that turns between two links; `carried` has the links that are fixed to massless ones."""
    for index, joint in enumerate(joints):
        if joint.type in HINGES and {joint.parent, carried.get(joint.child, joint.child)} == {a, b}:
            return index
    return None


def _axis(
    context: SdfContext, element: Element, tag: str, joint: Joint, poses: Sequence[Pose]
) -> Vector3 | None:
    """An axis of a gearbox in the frame of the model; None for that of the joint itself.

    One that states no frame of the model counts as that of the joint: it only tells the direction.
    """
    axis = element.first(tag)
    vector = None if axis is None else context.triple(axis, "xyz")
    if axis is None or vector is None:
        return None
    if context.text(axis, "use_parent_model_frame") in ("1", "true"):
        return vector
    return rotate(poses[joint.child].orientation, vector)


def _turn(joint: Joint, reference: int, poses: Sequence[Pose], axis: Vector3 | None) -> float:
    """1 or -1: how the angle about an axis, seen from the reference body, goes with the joint's position."""
    sense = 1.0 if joint.parent == reference else -1.0
    own = rotate(poses[joint.child].orientation, joint.axis)
    return sense if axis is None or dot(own, axis) >= 0.0 else -sense
