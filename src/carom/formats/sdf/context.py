"""State that all parts of the SDF reader share, and methods that read values from the text of elements."""

from __future__ import annotations

from math import hypot, pi

from carom.description import Pose
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import quaternion_from_rpy
from carom.files.xml_element import Element
from carom.formats.robot.context import FileContext, shown

_WORDS = {"true": True, "1": True, "false": False, "0": False}


class SdfContext(FileContext):
    """State of one reading; its root is the `<sdf>` element, and values are the text of child elements.

    Attributes:
        as_written: `relative_to` of links' poses counts, and limits that are not stated are none; PyBullet
            ignores the one and refuses or invents the others.
        missing_meshes: Shapes whose mesh is missing are left out and reported, in files read as written.
        words_are_true: `true` means 1 as in the format's specification, not 0 as in PyBullet.
    """

    words_are_true: bool = True
    as_written: bool = False
    missing_meshes: bool = False

    def text(self, parent: Element, tag: str) -> str | None:
        """The text of a child without surrounding white space; None if there is no such child."""
        child = parent.first(tag)
        return None if child is None else child.text.strip()

    def place(self, parent: Element, tag: str) -> tuple[Element, str]:  # noqa: D102
        return parent, tag

    def stated(self, element: Element, key: str) -> tuple[Element, str] | None:
        """The child of that name, and its text; None if there is no such child."""
        child = element.first(key)
        return None if child is None else (child, child.text.strip())

    def value_name(self, key: str) -> str:  # noqa: D102
        return f"<{key}>"

    def values(self, element: Element) -> list[float]:
        """All numbers in the text of an element."""
        return [self.parse_number(element, element.tag, word) for word in element.text.split()]

    def triple(self, parent: Element, tag: str) -> Vector3 | None:
        """The first three numbers in the text of a child; None without it, `DescriptionError` if fewer."""
        child = parent.first(tag)
        if child is None:
            return None
        numbers = self.values(child)
        if len(numbers) < 3:
            raise self.error(child, f"{shown(child.text.strip())} needs three numbers")
        return (numbers[0], numbers[1], numbers[2])

    def pose(self, parent: Element) -> Pose:
        """The `<pose>` of an element, or its `<origin>` as in URDF; scaled.

        As in PyBullet, the first three numbers are the position and the last three the angles, even if there
        are only three.
        """
        if parent.first("origin") is not None:
            return super().pose(parent)
        element = parent.first("pose")
        if element is None:
            return IDENTITY
        numbers = self.values(element)
        if self.as_written:
            return self._written_pose(element, numbers)
        if len(numbers) < 3:
            self.warn(element, f"{shown(element.text.strip())} needs six numbers; read as zeros")
            return IDENTITY
        if len(numbers) != 6:
            self.warn(
                element,
                f"{len(numbers)} numbers instead of six; the last three are read as angles, as in PyBullet",
            )
        if element.attributes.get("relative_to"):
            self.warn(element, "relative_to is not supported; the pose is taken in the enclosing frame")
        scale = self.scale
        x, y, z = numbers[:3]
        roll, pitch, yaw = numbers[-3:]
        return Pose((x * scale, y * scale, z * scale), quaternion_from_rpy(roll, pitch, yaw))

    def says(self, parent: Element, tag: str, *, default: bool = False) -> bool:
        """Whether a child holds a true word or a number that is not 0; raises `DescriptionError`."""
        text = self.text(parent, tag)
        if text is None:
            return default
        if text.lower() not in _WORDS:
            element = parent.first(tag) or parent
            raise self.error(element, f"{shown(text)} is neither true nor false")
        return _WORDS[text.lower()]

    def _written_pose(self, element: Element, numbers: list[float]) -> Pose:
        """A pose of three angles or of a quaternion, as its attributes say; empty for none."""
        attributes, scale = element.attributes, self.scale
        is_quaternion = attributes.get("rotation_format", "euler_rpy") == "quat_xyzw"
        if not numbers:
            return IDENTITY
        if len(numbers) != (7 if is_quaternion else 6):
            needed = "seven" if is_quaternion else "six"
            raise self.error(element, f"{shown(element.text.strip())} needs {needed} numbers")
        position = (numbers[0] * scale, numbers[1] * scale, numbers[2] * scale)
        if is_quaternion:
            x, y, z, w = numbers[3:]
            length = hypot(x, y, z, w)
            if length == 0.0:
                raise self.error(element, "the quaternion has no length")
            return Pose(position, (x / length, y / length, z / length, w / length))
        if not any(numbers[3:]):
            return Pose(position)
        factor = pi / 180.0 if attributes.get("degrees") in ("1", "true") else 1.0
        roll, pitch, yaw = (factor * angle for angle in numbers[3:])
        return Pose(position, quaternion_from_rpy(roll, pitch, yaw))
