"""SRDF files, which say more of the robot of a URDF file: groups of joints, states, links kept apart."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.reading.cursor import Cursor
from carom.formats.reading.ignored import IgnoredList
from carom.formats.reading.rules import Rule, Rules
from carom.formats.robot.context import FileContext, shown
from carom.formats.robot.file import locate
from carom.formats.search import AssetSearch
from carom.formats.xacro.document import expanded_if_xacro

_NO_LOSS = "none for the dynamics"
_PLANNING = "it is for motion planning"

SRDF_RULES: Rules = Rules(
    "SRDF",
    (
        Rule("disable_collisions@reason", _NO_LOSS, "it is a note"),
        Rule("enable_collisions@reason", _NO_LOSS, "it is a note"),
        Rule("robot/end_effector", _NO_LOSS, _PLANNING),
        Rule("robot/virtual_joint", "none: fixed_base says whether the base moves", _PLANNING),
        Rule("robot/passive_joint", "none: a joint without motor is one", _PLANNING),
        Rule("robot/joint_property", _NO_LOSS, _PLANNING),
        Rule("robot/link_sphere_approximation", "none: its own shapes collide", _PLANNING),
    ),
)


@dataclass(frozen=True, slots=True)
class JointPlace:
    """A joint of a robot.

    Attributes:
        name: Its name.
        link: Name of its link.
        parent: Name of the link that it hangs from.
        positions: How many numbers its position has.
        is_length: Its position is a length, to which the scale of the robot applies.
    """

    name: str
    link: str
    parent: str
    positions: int
    is_length: bool


@dataclass(eq=False, slots=True)
class Semantics:
    """What an SRDF file says of a robot.

    Attributes:
        groups: Names of the joints that move of each group, in the order of the robot.
        states: Positions of joints by name, of each state [rad or m].
        apart: Names of links that do not collide with each other.
        ignored: What it says and the simulation lacks.
    """

    groups: dict[str, tuple[str, ...]] = field(default_factory=dict)
    states: dict[str, dict[str, float]] = field(default_factory=dict)
    apart: list[tuple[str, str]] = field(default_factory=list)
    ignored: IgnoredList = field(default_factory=IgnoredList)


def read_srdf(
    path: Path,
    search: AssetSearch,
    base: str,
    joints: Sequence[JointPlace],
    *,
    scale: float = 1.0,
    xacro_args: Iterable[tuple[str, str]] = (),
) -> Semantics:
    """Read an SRDF file, or one of xacro that makes one.

    Args:
        path: The file, looked up with `AssetSearch.find`.
        search: The search for files.
        base: Name of the link that is the base of the robot.
        joints: The joints of the robot, parents before children.
        scale: Factor on lengths.
        xacro_args: Values of the arguments that a xacro file declares.

    Raises:
        DescriptionError: The file is missing or broken, or the robot has not what it names.
    """
    file = locate(path, search)
    with reading(file):
        data, _ = read_bounded(file)
        root = parse_root(data, file, "robot")
        if b"xacro" in data or file.suffix.lower() == ".xacro":
            # The same arguments are for the URDF file.
            declared = {it.attributes.get("name") for it in root.children if it.tag == "xacro:arg"}
            arguments = tuple(it for it in xacro_args if it[0] in declared)
            expanded = expanded_if_xacro(root, file, search, arguments)
            root = root if expanded is None else expanded.root
        cursor = Cursor(SRDF_RULES)
        context = FileContext(file, cursor.trace(root, file), scale, search)
        context.cursor = cursor
        context.root.attributes.get("name")
        found = _Reader(context, base, joints).read()
        found.ignored = cursor.ignored()
    return found


class _Reader:
    def __init__(self, context: FileContext, base: str, joints: Sequence[JointPlace]) -> None:
        self.context = context
        self.joints = {joint.name: joint for joint in joints}
        self.above = {joint.link: joint for joint in joints}
        self.links = [base, *(joint.link for joint in joints)]
        self.elements: dict[str, Element] = {}
        self.members: dict[str, set[str]] = {}

    def read(self) -> Semantics:
        root, found = self.context.root, Semantics()
        for element in root.all("group"):
            name = self.context.required(element, "name")
            if name in self.elements:
                raise self.context.error(element, f"there are two groups {shown(name)}")
            self.elements[name] = element
        for name, element in self.elements.items():
            members = self._members(name, element, ())
            found.groups[name] = tuple(
                it.name for it in self.joints.values() if it.name in members and it.positions
            )
        states = list(root.all("group_state"))
        names = [self.context.required(it, "name") for it in states]
        for element, name in zip(states, names, strict=True):
            group = self.context.required(element, "group")
            if group not in self.elements:
                raise self.context.error(element, f"there is no group {shown(group)}")
            full = name if names.count(name) == 1 else f"{group}/{name}"
            if full in found.states:
                problem = f"there are two states {shown(name)} of group {shown(group)}"
                raise self.context.error(element, problem)
            found.states[full] = dict(self._positions(element))
        found.apart = sorted(self._apart(root))
        return found

    def _members(self, name: str, element: Element, around: tuple[str, ...]) -> set[str]:
        """Names of the joints of a group, which may contain others; `around` are those that contain it."""
        if name in around:
            raise self.context.error(element, f"group {shown(name)} contains itself")
        if name not in self.members:
            found: set[str] = set()
            for child in element.children:
                if child.tag == "joint":
                    found.add(self._joint(child, self.context.required(child, "name")).name)
                elif child.tag == "link":
                    link = self._link(child, self.context.required(child, "name"))
                    found |= {self.above[link].name} if link in self.above else set()
                elif child.tag == "chain":
                    found |= self._chain(child)
                elif child.tag == "group":
                    other = self.context.required(child, "name")
                    if other not in self.elements:
                        raise self.context.error(child, f"there is no group {shown(other)}")
                    found |= self._members(other, self.elements[other], (*around, name))
            self.members[name] = found
        return self.members[name]

    def _chain(self, element: Element) -> set[str]:
        base, tip = (
            self._link(element, self.context.required(element, name)) for name in ("base_link", "tip_link")
        )
        found: set[str] = set()
        link = tip
        while link != base:
            if link not in self.above:
                raise self.context.error(element, f"link {shown(base)} is not above link {shown(tip)}")
            found.add(self.above[link].name)
            link = self.above[link].parent
        return found

    def _positions(self, element: Element) -> Iterable[tuple[str, float]]:
        for child in element.all("joint"):
            joint = self._joint(child, self.context.required(child, "name"))
            text = self.context.required(child, "value")
            if joint.positions != 1:
                consequence = "it keeps its position" if joint.positions else "none: it does not move"
                self.context.leave_out(child, consequence, "states have joints of one number", "value")
                continue
            value = self.context.parse_number(child, "value", text)
            yield joint.name, value * (self.context.scale if joint.is_length else 1.0)

    def _apart(self, root: Element) -> set[tuple[str, str]]:
        found: set[tuple[str, str]] = set()
        for element in root.all("disable_default_collisions"):
            link = self._link(element, self.context.required(element, "link"))
            found |= {_pair(link, other) for other in self.links if other != link}
        found |= {self._links_of(element) for element in root.all("disable_collisions")}
        return found - {self._links_of(element) for element in root.all("enable_collisions")}

    def _links_of(self, element: Element) -> tuple[str, str]:
        first, second = (
            self._link(element, self.context.required(element, part)) for part in ("link1", "link2")
        )
        return _pair(first, second)

    def _joint(self, element: Element, name: str) -> JointPlace:
        if name not in self.joints:
            raise self.context.error(element, f"the robot has no joint {shown(name)}")
        return self.joints[name]

    def _link(self, element: Element, name: str) -> str:
        if name not in self.links:
            raise self.context.error(element, f"the robot has no link {shown(name)}")
        return name


def _pair(first: str, second: str) -> tuple[str, str]:
    return (min(first, second), max(first, second))


def with_followers(
    positions: Mapping[str, float], mimics: Mapping[str, tuple[str, float, float]]
) -> dict[str, float]:
    """Positions of joints, and of those that follow them and have none: by leader, multiplier and offset."""
    found = dict(positions)
    while True:
        more = {
            name: offset + multiplier * found[leader]
            for name, (leader, multiplier, offset) in mimics.items()
            if name not in found and leader in found
        }
        if not more:
            return found
        found |= more
