"""The check that links and joints form one tree."""

from __future__ import annotations

from collections.abc import Sequence

from carom.description import Joint, Link
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown

_MAX_NAMES = 8


def find_root(
    context: FileContext, links: Sequence[Link], joints: Sequence[Joint], joint_elements: Sequence[Element]
) -> int:
    """Index of the root link.

    Raises:
        DescriptionError: A link is the child of two joints, there are several roots, or links form a loop.
    """
    carrier: list[int | None] = [None] * len(links)
    for index, joint in enumerate(joints):
        first = carrier[joint.child]
        if first is not None:
            raise context.error(
                joint_elements[index],
                f"link {shown(links[joint.child].name)} is already the child of "
                f"joint {shown(joints[first].name)}",
            )
        carrier[joint.child] = index
    roots = [index for index, joint in enumerate(carrier) if joint is None]
    if len(roots) > 1:
        raise context.error(
            context.root,
            f"{len(roots)} root links, where one is needed: {_listed([links[i].name for i in roots])}",
        )
    looped = set(range(len(links))) - _reachable(roots, joints, len(links))
    if looped:
        raise context.error(
            context.root, f"links form a loop: {_listed([links[i].name for i in sorted(looped)])}"
        )
    return roots[0]


def _reachable(roots: list[int], joints: Sequence[Joint], count: int) -> set[int]:
    children: list[list[int]] = [[] for _ in range(count)]
    for joint in joints:
        children[joint.parent].append(joint.child)
    seen: set[int] = set()
    pending = list(roots)
    while pending:
        link = pending.pop()
        seen.add(link)
        pending.extend(children[link])
    return seen


def _listed(names: list[str]) -> str:
    listed = ", ".join(shown(name) for name in names[:_MAX_NAMES])
    return listed if len(names) <= _MAX_NAMES else f"{listed} and {len(names) - _MAX_NAMES} more"
