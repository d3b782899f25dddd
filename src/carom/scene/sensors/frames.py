"""Frames on links: where they are and how they move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.description.pose import IDENTITY, Pose
from carom.description.sensor import SensorObject, SensorSpec
from carom.description.transform import compose, inverse
from carom.errors import DescriptionError
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import cross, product, turned

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


class Frame(NamedTuple):
    """A frame on a link.

    Attributes:
        body: The body.
        link: Index of the link.
        pose: The frame in the inertial frame of the link.
    """

    body: BodyCore
    link: int
    pose: Pose

    @property
    def row(self) -> int:
        """Row of the link."""
        return self.body.first_link + 1 + self.link


class Placement(NamedTuple):
    """Position and orientation of a frame in each world: (count, 3) and (count, 4)."""

    position: Array
    orientation: Array


class Motion(NamedTuple):
    """Velocity of the origin of a frame and its angular velocity in each world, world axes, (count, 3)."""

    linear: Array
    angular: Array


def frame_of(body: BodyCore, kind: SensorObject, name: str) -> Frame:
    """A frame of a body by the kind of thing that has it, and its name.

    Raises:
        DescriptionError: There is no such site or link.
    """
    if kind is SensorObject.SITE:
        for site in body.spec.sites:
            if site.name == name:
                to_inertial = inverse(body.link_inertial_frame(site.link))
                return Frame(body, site.link, compose(to_inertial, site.pose))
        known = [site.name for site in body.spec.sites]
    else:
        known = [body.spec.base.name, *(link.name for link in body.spec.links)]
        if name in known:
            link = known.index(name) - 1
            own = kind is SensorObject.INERTIAL_FRAME
            return Frame(body, link, IDENTITY if own else inverse(body.link_inertial_frame(link)))
    what = "site" if kind is SensorObject.SITE else "link"
    names = ", ".join(map(repr, known)) or "none"
    raise DescriptionError(f"body {body.name!r} has no {what} {name!r}; it has {names}")


def object_frame(body: BodyCore, spec: SensorSpec) -> Frame:
    """The frame that a sensor measures."""
    return frame_of(body, spec.object_type, spec.object)


def reference_frame(bodies: Mapping[int, BodyCore], body: BodyCore, spec: SensorSpec) -> Frame | None:
    """The frame that it is seen from; None for the world.

    Raises:
        DescriptionError: There is no such body, site or link, or more than one such body.
    """
    if spec.reference_type is SensorObject.NONE:
        return None
    return frame_of(reference_body(bodies, body, spec), spec.reference_type, spec.reference)


def reference_body(bodies: Mapping[int, BodyCore], body: BodyCore, spec: SensorSpec) -> BodyCore:
    """The body that has the reference of a sensor of a body.

    Raises:
        DescriptionError: There is no such body, or more than one.
    """
    if spec.reference_body:
        found = [other for other in bodies.values() if other.name == spec.reference_body]
        if len(found) != 1:
            raise DescriptionError(
                f"sensor {spec.name!r}: {len(found)} bodies have the name {spec.reference_body!r} of its "
                "reference; one should"
            )
        (body,) = found
    return body


def placement(source: Source, frame: Frame) -> Placement:
    """Where a frame is."""
    pose = source.poses(frame.body)[:, frame.row]
    turn = pose[:, 3:]
    offset = turned(turn, np.array([frame.pose.position]))
    return Placement(pose[:, :3] + offset, product(turn, np.array([frame.pose.orientation])))


def motion(source: Source, frame: Frame) -> Motion:
    """How a frame moves."""
    velocity = source.velocities(frame.body)[:, frame.row]
    turn = source.poses(frame.body)[:, frame.row, 3:]
    offset = turned(turn, np.array([frame.pose.position]))
    angular = velocity[:, 3:].copy()
    return Motion(velocity[:, :3] + cross(angular, offset), angular)


class Frames:
    """Frames on links of a body, as arrays: where they are and how they move, (worlds, frames, ...)."""

    def __init__(self, frames: Sequence[Frame]) -> None:
        self._rows = np.array([frame.row for frame in frames])
        self._offsets = np.array([frame.pose.position for frame in frames])
        self._turns = np.array([frame.pose.orientation for frame in frames])

    def find(self, poses: Array, velocities: Array) -> None:
        """Find them for poses and velocities of links."""
        pose, velocity = poses[:, self._rows], velocities[:, self._rows]
        turn = pose[..., 3:]
        arm = turned(turn, self._offsets)
        self.position: Array = pose[..., :3] + arm
        self.orientation: Array = product(turn, self._turns)
        self.angular: Array = velocity[..., 3:]
        self.linear: Array = velocity[..., :3] + cross(self.angular, arm)
