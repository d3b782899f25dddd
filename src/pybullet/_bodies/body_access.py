"""Direct access to the state of bodies: the base, the joints and the links."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import addressof
from functools import cached_property
from struct import Struct
from typing import TYPE_CHECKING

from carom.description.pose import Quaternion, Vector3
from carom.description.transform import inverse, multiplied
from pybullet._joints.joint_access import JointAccess, joint_access
from pybullet._joints.joint_groups import JointGroup, JointGroups
from pybullet._joints.joint_info import JointInfo, joint_info
from pybullet._maths.rotations import canonical, turned

if TYPE_CHECKING:
    from carom.algorithms.ask import Ask
    from carom.algorithms.mechanism import Mechanism
    from carom.layouts.quick_bodies import Body as Record
    from carom.scene.body import Body
    from pybullet._bodies.link_box import LinkBox, SoftBox
    from pybullet._bodies.quick_bodies import QuickBodies
    from pybullet._clients.clients import Client

_POSE, _SPATIAL = Struct("7d"), Struct("6d")
_read_pose = _POSE.unpack_from
_read_spatial, _write_spatial = _SPATIAL.unpack_from, _SPATIAL.pack_into
_AT_REST = (0.0,) * 6
_NO_TURN = (0.0, 0.0, 0.0, 1.0)

LinkState = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion]
LinkStateWithVelocity = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion, Vector3, Vector3]


class LinkAccess:
    """Direct access to the state of one link other than the base."""

    __slots__ = ("frame", "from_inertial", "pose_at", "poses", "rotated", "velocities", "velocity_at")

    def __init__(self, client: Client, body: Body, index: int) -> None:
        row = body.first_link + 1 + index
        self.poses = client.world.link_pose_memory
        self.pose_at = row * _POSE.size
        self.velocities = client.world.link_velocity_memory
        self.velocity_at = row * _SPATIAL.size
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
        vx, vy, vz, wx, wy, wz = _read_spatial(self.velocities, self.velocity_at)
        return ((vx, vy, vz), (wx, wy, wz))

    def pose(self) -> tuple[Vector3, Quaternion]:
        """World pose of the inertial frame."""
        x, y, z, qx, qy, qz, qw = _read_pose(self.poses, self.pose_at)
        return (x, y, z), (qx, qy, qz, qw)


class BodyAccess:
    """Direct access to the state of one body.

    Attributes:
        body: The body itself.
        acts_twice: External forces act twice on it, as in PyBullet, see `Client.maximal`.
        joints: Access to its joints, by index.
        groups: Access to groups of its joints, by the tuple of their indices.
        record: The body's record for the native library; None if Python handles all calls.
    """

    def __init__(self, client: Client, body: Body) -> None:
        self.body = body
        self.acts_twice: bool = client.deformable and body.id in client.maximal
        self._client = client
        self._positions = client.world.position_memory
        self._velocities = client.world.velocity_memory
        self._position_at = body.first_position * 8
        self._velocity_at = body.first_velocity * 8
        self.joints: dict[int, JointAccess] = {
            index: joint_access(client, body, index) for index in range(body.joint_count)
        }
        self.groups = JointGroups(client, self.joints)
        self.record: Record | None = None

    @cached_property
    def links(self) -> dict[int, LinkAccess]:
        """Access to the links other than the base, by index."""
        links = {index: LinkAccess(self._client, self.body, index) for index in range(self.body.joint_count)}
        if self.record is not None:
            from pybullet._bodies.quick_bodies import link_records

            self._link_records = link_records(links.values())
            self.record.links = addressof(self._link_records)
        return links

    def forget_moments(self, link: int) -> None:
        """Let the moments of a link be computed anew when its mass changes next; -1 is the base."""
        if self.record is not None and self.record.moments:
            self._moments[link + 1].is_known = False

    def weighed(self, link: int) -> None:
        """Let the native library handle the next changes of a link's mass; -1 is the base."""
        if self.record is None:
            return
        from carom.layouts.quick_bodies import Moments
        from carom.scene.dynamics_changes import shape_terms
        from pybullet._bodies.quick_bodies import write_moments

        if not self.record.moments:
            self._moments = (Moments * (self.body.joint_count + 1))()
            self.record.moments = addressof(self._moments)
        if not self._moments[link + 1].is_known:
            write_moments(self._moments[link + 1], shape_terms(self.body, link))

    def commanded(self, group: JointGroup) -> None:
        """Let the native library handle the next commands to this group of joints."""
        if self.record is not None and group.record is not None:
            # `_group` keeps the record alive while the library uses it. The old record is withdrawn first.
            self.record.motors = None
            self._group = group
            self.record.motors = addressof(group.record)

    @cached_property
    def boxes(self) -> Mapping[int, LinkBox | SoftBox]:
        """The bounding boxes of the links, by index, -1 for the base."""
        # Created on demand: most scripts never need the boxes, and these imports are slow.
        from pybullet._bodies.link_box import LinkBox, SoftBox

        if self.body.spec.soft is not None:
            return {-1: SoftBox(self.body)}
        boxes = {index: LinkBox(self._client, self.body, index) for index in range(-1, self.body.joint_count)}
        if self.record is not None:
            from pybullet._bodies.quick_bodies import box_records

            self._box_records = box_records(boxes.values())
            self.record.boxes = addressof(self._box_records)
        return boxes

    @cached_property
    def mechanism(self) -> Mechanism | None:
        """The body's equations of motion; None if a joint has more than one degree of freedom."""
        if any(freedoms > 1 for freedoms in self.body.velocity_count):
            return None
        from carom.algorithms.mechanism import mechanism_of

        return mechanism_of(self.body)

    @cached_property
    def joint_infos(self) -> dict[int, JointInfo]:
        """The return values of `getJointInfo`, by joint index."""
        return {index: joint_info(self.body, index) for index in range(self.body.joint_count)}

    def forget_inertia(self) -> None:
        """Drop only the data that depend on masses and inertias: some scripts change a mass at every step."""
        self.__dict__.pop("mechanism", None)

    def base_pose(self) -> tuple[Vector3, Quaternion]:
        """World pose of the base's inertial frame."""
        x, y, z, qx, qy, qz, qw = _read_pose(self._positions, self._position_at)
        return ((x, y, z), canonical((qx, qy, qz, qw)))

    def base_velocity(self) -> tuple[Vector3, Vector3]:
        """Velocity of the base's centre of mass and its angular velocity, in world axes."""
        wx, wy, wz, vx, vy, vz = _read_spatial(self._velocities, self._velocity_at)
        return ((vx, vy, vz), (wx, wy, wz))

    def inertial_frame(self, link: int) -> tuple[Vector3, Quaternion]:
        """World pose of a link's inertial frame; -1 is the base."""
        return self.base_pose() if link < 0 else self.links[link].pose()

    def place_base(self, position: Vector3, orientation: Quaternion) -> None:
        """Set the pose of the base and its velocity to 0, as `resetBasePositionAndOrientation` does."""
        with self._client.lock:
            if self.body.spec.soft is not None:
                self.body.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
            _write_spatial(self._velocities, self._velocity_at, *_AT_REST)
            before = self.body.coordinates()
            self.body.set_base_pose(position, orientation)
            self.body.note_reset(moved=self.body.coordinates() != before)

    def push(self, link: int, force: Vector3, torque: Vector3) -> None:
        """Add a force [N] and a torque about the centre of mass [N m] to a link, in world axes; -1: base."""
        wrenches = self._client.world.link_force_memory
        at = (self.body.first_link + 1 + link) * _SPATIAL.size
        fx, fy, fz, tx, ty, tz = _read_spatial(wrenches, at)
        (x, y, z), (rx, ry, rz) = force, torque
        if self.acts_twice:
            x, y, z, rx, ry, rz = 2.0 * x, 2.0 * y, 2.0 * z, 2.0 * rx, 2.0 * ry, 2.0 * rz
        _write_spatial(wrenches, at, fx + x, fy + y, fz + z, tx + rx, ty + ry, tz + rz)


class BodyTable(dict[int, BodyAccess]):
    """Direct access to the bodies of one client, by id; an entry is created on first use.

    The id of a body that does not exist raises `KeyError`.

    Attributes:
        client: The client, which sets this attribute when it is created.
        forces_of_motion: The functions for `calculateInverseDynamics`, by body id; a plain dictionary,
            because its look-up is fastest.
        quick: The records of these bodies for the native library; None if Python handles all calls.
    """

    __slots__ = ("client", "forces_of_motion", "quick")

    def __init__(self) -> None:
        super().__init__()
        self.client: Client
        self.forces_of_motion: dict[int, Ask] = {}
        self.quick: QuickBodies | None = None

    def forget(self, body_id: int) -> None:
        """Drop the access to a body, because data that it caches change."""
        if self.quick is not None:
            self.quick.hide(body_id)
        self.pop(body_id, None)
        self.forces_of_motion.pop(body_id, None)

    def forget_inertia(self, body_id: int) -> None:
        """Drop data that depend on the masses and inertias of a body."""
        access = self.get(body_id)
        if access is not None:
            access.forget_inertia()
        self.forces_of_motion.pop(body_id, None)

    def forget_all(self) -> None:
        """Drop the access to all bodies."""
        if self.quick is not None:
            self.quick.hide_all()
        self.clear()
        self.forces_of_motion.clear()

    def __missing__(self, body_id: int) -> BodyAccess:
        access = BodyAccess(self.client, self.client.world.bodies[body_id])
        self[body_id] = access
        if self.quick is not None:
            self.quick.show(access)
        return access
