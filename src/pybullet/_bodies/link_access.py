"""Direct access to poses and velocities of links."""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from carom.description.pose import Quaternion, Vector3
from carom.description.transform import inverse, multiplied
from pybullet._maths.rotations import canonical, turned

if TYPE_CHECKING:
    from carom.scene.body import Body
    from pybullet._clients.clients import Client

LinkState = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion]
LinkStateWithVelocity = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion, Vector3, Vector3]

_read_pose = Struct("7d").unpack_from
_read_velocity = Struct("6d").unpack_from
_POSE_ROW = 7 * 8
_VELOCITY_ROW = 6 * 8
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class LinkAccess:
    """Direct access to the state of one link other than the base."""

    __slots__ = ("frame", "from_inertial", "pose_at", "poses", "rotated", "velocities", "velocity_at")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        row = body.first_link + 1 + index
        self.poses = client.world.link_pose_memory
        self.pose_at = row * _POSE_ROW
        self.velocities = client.world.link_velocity_memory
        self.velocity_at = row * _VELOCITY_ROW
        frame = body.link_inertial_frame(index)
        self.frame = (frame.position, frame.orientation)
        self.from_inertial = inverse(frame)
        self.rotated = self.from_inertial.orientation != _NO_TURN

    def state(self) -> LinkState:
        """World pose of the inertial frame, its pose in the link frame, and world pose of the link frame."""
        x, y, z, qx, qy, qz, qw = _read_pose(self.poses, self.pose_at)
        orientation = (qx, qy, qz, qw)
        dx, dy, dz = turned(orientation, self.from_inertial.position)
        return (
            (x, y, z),
            orientation,
            *self.frame,
            (x + dx, y + dy, z + dz),
            canonical(multiplied(orientation, self.from_inertial.orientation))
            if self.rotated
            else orientation,
        )

    def velocity(self) -> tuple[Vector3, Vector3]:
        """Velocity of the centre of mass and angular velocity, in world axes."""
        vx, vy, vz, wx, wy, wz = _read_velocity(self.velocities, self.velocity_at)
        return ((vx, vy, vz), (wx, wy, wz))

    def pose(self) -> tuple[Vector3, Quaternion]:
        """World pose of the inertial frame."""
        x, y, z, qx, qy, qz, qw = _read_pose(self.poses, self.pose_at)
        return (x, y, z), (qx, qy, qz, qw)
