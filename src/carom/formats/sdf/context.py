"""State that all parts of the SDF reader share, and methods that read values from the text of elements."""

from __future__ import annotations

from carom.description import Pose
from carom.description.pose import IDENTITY, Vector3
from carom.description.transform import quaternion_from_rpy
from carom.formats.robot.context import FileContext, shown
from carom.formats.xml_element import Element


class SdfContext(FileContext):
    """State of one reading; its root is the `<sdf>` element, and values are the text of child elements.

    Attributes:
        as_written: `relative_to` of links' poses counts, and limits that are not stated are none; PyBullet
            ignores the one and refuses or invents the others.
        words_are_true: `true` means 1 as in the format's specification, not 0 as in PyBullet.
    """

    words_are_true: bool = True
    as_written: bool = False

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
        if len(numbers) < 3:
            self.warn(element, f"{shown(element.text.strip())} needs six numbers; read as zeros")
            return IDENTITY
        if len(numbers) != 6:
            self.warn(
                element,
                f"{len(numbers)} numbers instead of six; the last three are read as angles, as in PyBullet",
            )
        if not self.as_written and element.attributes.get("relative_to"):
            self.warn(element, "relative_to is not supported; the pose is taken in the enclosing frame")
        scale = self.scale
        x, y, z = numbers[:3]
        roll, pitch, yaw = numbers[-3:]
        return Pose((x * scale, y * scale, z * scale), quaternion_from_rpy(roll, pitch, yaw))
