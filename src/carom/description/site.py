"""Sites: named frames on links, with a small volume, for sensors, tendons and users."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import inf

from carom.description.link import Rgba
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.errors import DescriptionError


class SiteShape(Enum):
    """Shape of the volume of a site."""

    SPHERE = "sphere"
    CAPSULE = "capsule"
    ELLIPSOID = "ellipsoid"
    CYLINDER = "cylinder"
    BOX = "box"


@dataclass(frozen=True, slots=True)
class SiteSpec:
    """A frame on a link.

    Attributes:
        name: Its name among the sites of the body.
        link: Index of its link; -1 is the base.
        pose: The frame in the link frame.
        shape: Shape of its volume, in which touch sensors count contacts.
        size: Sphere: the radius, then two unused numbers. Capsule and cylinder along z: radius, half of the
            length (without the caps of a capsule), an unused number. Ellipsoid and box: half axes [m].
        rgba: Its colour, if it is to be seen; None for a site that is not drawn.
        group: Number of its group, which windows show or hide.
    """

    name: str
    link: int = -1
    pose: Pose = IDENTITY
    shape: SiteShape = SiteShape.SPHERE
    size: Vector3 = (0.005, 0.005, 0.005)
    rgba: Rgba | None = None
    group: int = 0

    def check(self) -> None:
        """Raise `DescriptionError` unless the numbers have a meaning."""
        numbers = (*self.pose.position, *self.pose.orientation, *self.size)
        if not all(-inf < number < inf for number in numbers):
            raise DescriptionError(f"site {self.name!r}: its pose and its size must be finite")
        if not all(number >= 0.0 for number in self.size):
            raise DescriptionError(f"site {self.name!r}: its size must not be negative")
