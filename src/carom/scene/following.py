"""How cameras follow bodies: with a part of a body, but without its turns, or by looking at one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import Matrix3, compose, quaternion_from_matrix


class FollowedLink(Protocol):
    """What is needed of a `carom.scene.link.Link`."""

    @property
    def spec(self) -> Any:
        """Its specification, with its mass."""
        ...

    @property
    def inertial_frame(self) -> Pose:
        """Centre of mass and principal axes in the link frame."""
        ...


FrameOf = Callable[[Any], Pose]
"""World pose of the frame of a link."""

_LEAST = 1e-15


@dataclass(frozen=True, eq=False, slots=True)
class Point:
    """A point of a body: the origin of a link, or the centre of mass of several.

    Attributes:
        links: The links; none for a point of the world.
        is_centre: It is their centre of mass, and the origin of the first one if they have no mass.
        of_world: The point if there are no links.
    """

    links: Sequence[FollowedLink]
    is_centre: bool = False
    of_world: Vector3 = (0.0, 0.0, 0.0)

    def position(self, frame_of: FrameOf) -> Vector3:
        """Where it is in the world [m]."""
        if not self.links:
            return self.of_world
        total = x = y = z = 0.0
        for link in self.links if self.is_centre else ():
            mass, centre = link.spec.mass, compose(frame_of(link), link.inertial_frame).position
            total += mass
            x, y, z = (a + mass * b for a, b in zip((x, y, z), centre, strict=True))
        if total > 0.0:
            return x / total, y / total, z / total
        return frame_of(self.links[0]).position


@dataclass(frozen=True, eq=False, slots=True)
class Following:
    """How a camera moves apart from the link that it is mounted on.

    Attributes:
        moves_with: The camera keeps its distance from this point, along the axes of the world, and its
            orientation; None for one that moves with its link.
        offset: That distance [m].
        orientation: That orientation.
        looks_at: The point in the middle of its image, with the z axis of the world upwards; None for one
            that looks where its link points.
    """

    moves_with: Point | None = None
    offset: Vector3 = (0.0, 0.0, 0.0)
    orientation: Quaternion = (0.0, 0.0, 0.0, 1.0)
    looks_at: Point | None = None

    def pose(self, pose: Pose, frame_of: FrameOf) -> Pose:
        """World pose of the camera, whose pose is this where it moves with its link."""
        if self.moves_with is not None:
            x, y, z = self.moves_with.position(frame_of)
            a, b, c = self.offset
            return Pose((x + a, y + b, z + c), self.orientation)
        if self.looks_at is not None:
            return Pose(pose.position, _towards(pose.position, self.looks_at.position(frame_of)))
        return pose


def _towards(eye: Vector3, target: Vector3) -> Quaternion:
    """The orientation of a camera that looks at a point: along z, with y down in the image.

    If eye and target are at one place it looks along -x, and with x to the right where it looks straight up
    or down, as in MuJoCo.
    """
    forth = _unit((target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]), (-1.0, 0.0, 0.0))
    right = _unit((forth[1], -forth[0], 0.0), (1.0, 0.0, 0.0))
    (fx, fy, fz), (rx, ry, _) = forth, right
    down = (-fz * ry, fz * rx, fx * ry - fy * rx)
    columns: Matrix3 = (right, down, forth)
    turned: Matrix3 = tuple(zip(*columns, strict=True))  # pyright: ignore[reportAssignmentType]
    return quaternion_from_matrix(turned)


def _unit(vector: Vector3, otherwise: Vector3) -> Vector3:
    size = (vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2) ** 0.5
    return (vector[0] / size, vector[1] / size, vector[2] / size) if size > _LEAST else otherwise
