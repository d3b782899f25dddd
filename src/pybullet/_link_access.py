"""Links as scripts see them: direct access to their poses and velocities."""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from carom.description.pose import Pose, Quaternion, Vector3
from carom.description.transform import inverse, multiplied

if TYPE_CHECKING:
    from carom.body import Body
    from pybullet._clients import Client

LinkState = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion]
LinkStateWithVelocity = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion, Vector3, Vector3]

_read_pose = Struct("7d").unpack_from
_read_velocity = Struct("6d").unpack_from
_POSE_ROW = 7 * 8
_VELOCITY_ROW = 6 * 8
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class LinkAccess:
    """One link other than the base."""

    __slots__ = ("frame", "from_inertial", "pose_at", "poses", "turned", "velocities", "velocity_at")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        row = body.first_link + 1 + index
        self.poses = client.world.link_pose_memory
        self.pose_at = row * _POSE_ROW
        self.velocities = client.world.link_velocity_memory
        self.velocity_at = row * _VELOCITY_ROW
        frame = body.link_inertial_frame(index)
        self.frame = (frame.position, frame.orientation)
        self.from_inertial = inverse(frame)
        self.turned = self.from_inertial.orientation != _NO_TURN

    def state(self) -> LinkState:
        """World poses of the inertial frame and of the link frame, and the former in the latter."""
        x, y, z, qx, qy, qz, qw = _read_pose(self.poses, self.pose_at)
        orientation = (qx, qy, qz, qw)
        a, b, c = self.from_inertial.position
        # The position of the link frame in the inertial frame, turned by the quaternion.
        tx = 2.0 * (qy * c - qz * b)
        ty = 2.0 * (qz * a - qx * c)
        tz = 2.0 * (qx * b - qy * a)
        return (
            (x, y, z),
            orientation,
            *self.frame,
            (
                x + a + qw * tx + qy * tz - qz * ty,
                y + b + qw * ty + qz * tx - qx * tz,
                z + c + qw * tz + qx * ty - qy * tx,
            ),
            canonical(multiplied(orientation, self.from_inertial.orientation))
            if self.turned
            else orientation,
        )

    def velocity(self) -> tuple[Vector3, Vector3]:
        """Velocity of the centre of mass and angular velocity, in world axes."""
        vx, vy, vz, wx, wy, wz = _read_velocity(self.velocities, self.velocity_at)
        return ((vx, vy, vz), (wx, wy, wz))

    def pose(self) -> Pose:
        """World pose of the inertial frame."""
        x, y, z, qx, qy, qz, qw = _read_pose(self.poses, self.pose_at)
        return Pose((x, y, z), (qx, qy, qz, qw))


def canonical(quaternion: Quaternion) -> Quaternion:
    """The one of the two quaternions of a rotation that PyBullet reports.

    It reads it off a rotation matrix: w is positive while the trace is, or else the largest of x, y
    and z is.
    """
    x, y, z, w = quaternion
    leading = w if w * w > 0.25 else max(x, y, z, key=abs)
    return (-x, -y, -z, -w) if leading < 0.0 else quaternion
