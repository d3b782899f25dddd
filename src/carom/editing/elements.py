"""Elements of a description: making, copying and going through them, and numbers in their attributes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from carom.description.pose import IDENTITY, Pose, Quaternion
from carom.description.transform import quaternion_from_matrix, rotation_matrix
from carom.errors import DescriptionError
from carom.files.xml_element import Element, PlacedElement

SECTIONS = (
    "compiler", "option", "size", "visual", "statistic", "default", "extension", "custom", "asset",
    "worldbody", "deformable", "contact", "equality", "tendon", "actuator", "sensor", "keyframe",
)  # fmt: skip
"""The sections of a description, in the order in which they are written."""
ORIENTATIONS = ("quat", "euler", "axisangle", "xyaxes", "zaxis")
IN_BODIES = ("geom", "joint", "freejoint", "site", "camera", "light", "inertial")
UNBUILT_BODIES = ("composite", "flexcomp", "plugin")


def new(tag: str, like: Element | None = None, attributes: Mapping[str, str] | None = None) -> PlacedElement:
    """An element with a copy of attributes; errors about it name the place of another one in its file."""
    line, file = (0, Path()) if like is None else (like.line, file_of(like))
    calls = getattr(like, "calls", ())
    return PlacedElement(tag, dict(attributes or {}), line, file, calls)


def file_of(element: Element) -> Path:
    """The file that an element was read from."""
    return getattr(element, "file", Path())


def copied(element: Element) -> PlacedElement:
    """A copy of an element with all inside it."""
    copy = new(element.tag, element, element.attributes)
    copy.text = element.text
    copy.children = [copied(child) for child in element.children]
    return copy


def walk(element: Element) -> Iterator[Element]:
    """An element and all inside it, in document order."""
    yield element
    for child in element.children:
        yield from walk(child)


def pairs(element: Element) -> Iterator[tuple[Element, Element]]:
    """Each element inside an element, with the one around it, in document order."""
    for child in element.children:
        yield element, child
        yield from pairs(child)


def section(root: Element, tag: str) -> Element:
    """A section of a description; made where it belongs if there is none."""
    found = root.first(tag)
    if found is None:
        found = new(tag, root)
        order = SECTIONS.index(tag)
        places = (at for at, it in enumerate(root.children) if it.tag in SECTIONS[order + 1 :])
        root.children.insert(next(places, len(root.children)), found)
    return found


def bodies(root: Element) -> Iterator[Element]:
    """All bodies of a description, in document order, without the world."""
    return (it for world in root.all("worldbody") for it in walk(world) if it.tag == "body")


def words(values: Iterable[float]) -> str:
    """Numbers as they are written: with all their digits."""
    return " ".join(_word(float(value)) for value in values)


def _word(value: float) -> str:
    text = repr(value + 0.0)
    return text.removesuffix(".0")


def numbers(element: Element, name: str, default: tuple[float, ...] = ()) -> tuple[float, ...]:
    """The numbers of an attribute; raises `DescriptionError` if it has others words."""
    text = element.attributes.get(name)
    if text is None:
        return default
    try:
        return tuple(float(word) for word in text.split())
    except ValueError:
        raise error(element, f"{name}={text!r} must be numbers") from None


def error(element: Element, reason: str) -> DescriptionError:
    """An error about an element, with its file and line if it came from one."""
    name = element.attributes.get("name")
    what = f"<{element.tag}>" if name is None else f"<{element.tag} name={name!r}>"
    file = file_of(element)
    return DescriptionError(
        reason, file=file if element.line else None, line=element.line or None, element=what
    )


def pose_of(element: Element) -> Pose:
    """The pose that `pos` and `quat` of an element state."""
    x, y, z = numbers(element, "pos", (0.0, 0.0, 0.0))
    w, i, j, k = numbers(element, "quat", (1.0, 0.0, 0.0, 0.0))
    if (w, i, j, k) == (1.0, 0.0, 0.0, 0.0):
        return Pose((x, y, z))
    return Pose((x, y, z), quaternion_from_matrix(rotation_matrix((i, j, k, w))))


def place(element: Element, pose: Pose) -> None:
    """State a pose by `pos` and `quat`, which are left out where they are 0 or turn nothing."""
    for name in ("pos", *ORIENTATIONS):
        element.attributes.pop(name, None)
    if any(pose.position) or element.tag == "inertial":
        element.attributes["pos"] = words(pose.position)
    if pose.orientation != IDENTITY.orientation:
        element.attributes["quat"] = quat(pose.orientation)


def quat(orientation: Quaternion) -> str:
    """A quaternion (x, y, z, w) as MJCF has it: w first."""
    x, y, z, w = orientation
    return words((w, x, y, z))
