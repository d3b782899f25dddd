"""The bounding boxes of links, for `getAABB`."""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.description.shapes.bounds import turned_box
from carom.description.transform import NO_ROTATION, rotation_matrix
from carom.model.body_spec import BASE
from carom.model.inertia import is_in_place
from carom.scene.soft_body import SoftBody

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_POSE = Struct("7d")
_read_pose = _POSE.unpack_from
_DOUBLE = 8


class LinkBox:
    """The bounding box of one link, at the link's present pose.

    Attributes:
        center: Centre of the box in the inertial frame of the link [m].
        half: Half its size along the axes of the inertial frame [m].
        is_moved: Whether the box moves with the link; the box of a plane does not.
        is_turned: Whether the box rotates with the link; the box of a sphere does not.
    """

    __slots__ = ("_at", "_poses", "center", "half", "is_moved", "is_turned")

    def __init__(self, world: World, body: Body, link: int) -> None:
        row, spec = body.first_link + 1 + link, body.link_spec(link)
        alone = is_in_place(spec.collisions, spec.inertial_frame)
        lone = spec.collisions[0].geometry if alone else None
        self.is_moved = lone is None or not lone.is_unbounded
        self.is_turned = self.is_moved and (lone is None or lone.bounds_turn)
        bounds = world.contact_arrays.shapes.bounds(row)
        self.center, self.half = bounds.center, bounds.half
        # Read the base's pose from its coordinates: after a step, link poses are one substep behind.
        self._poses = world.position_memory if link == BASE else world.link_pose_memory
        self._at = body.first_position * _DOUBLE if link == BASE else row * _POSE.size

    def corners(self) -> tuple[Vector3, Vector3]:
        """The minimum and the maximum corner, in the world frame [m]."""
        center, half = self.center, self.half
        if self.is_moved:
            x, y, z, qx, qy, qz, qw = _read_pose(self._poses, self._at)
            rotation = rotation_matrix((qx, qy, qz, qw)) if self.is_turned else NO_ROTATION
            center, half = turned_box(center, half, rotation, (x, y, z))
        (cx, cy, cz), (hx, hy, hz) = center, half
        return (cx - hx, cy - hy, cz - hz), (cx + hx, cy + hy, cz + hz)


class SoftBox:
    """The bounding box of a soft body, for the present positions of its nodes."""

    __slots__ = ("_body",)

    def __init__(self, body: Body) -> None:
        assert isinstance(body, SoftBody)
        self._body = body

    def corners(self) -> tuple[Vector3, Vector3]:
        """The minimum and the maximum corner, in the world frame [m]."""
        (ax, ay, az), (bx, by, bz) = (corner.tolist() for corner in self._body.corners())
        return (ax, ay, az), (bx, by, bz)
