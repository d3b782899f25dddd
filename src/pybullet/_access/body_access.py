"""Direct access to the state of bodies: the base, the joints and the links."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import addressof, c_int32
from functools import cached_property
from math import nan
from typing import TYPE_CHECKING, Any, Protocol, cast
from weakref import ref

from carom.description.pose import Quaternion, Vector3
from carom.native.arrays import c_array
from carom.native.change import Change, blank
from pybullet._access.joint_info import JointInfo, joint_info
from pybullet._access.quick_bodies import QuickBodies, box_records, link_records, write_moments
from pybullet._calls.errors import error, no_body

if TYPE_CHECKING:
    from carom.algorithms.ask import Ask
    from carom.algorithms.mechanism import Mechanism
    from carom.layouts.quick.bodies import Body as Record
    from carom.scene.body import Body
    from carom.world.world import World
    from pybullet._access.link_box import LinkBox, SoftBox

LinkState = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion]
LinkStateWithVelocity = tuple[Vector3, Quaternion, Vector3, Quaternion, Vector3, Quaternion, Vector3, Vector3]
Wrench = tuple[float, ...]
JointState = tuple[float, float, Wrench, float]
MultiDofState = tuple[tuple[float, ...], tuple[float, ...], Wrench, tuple[float, ...]]

# Numbers in the results of kernels.
_POSE, _TWIST, _JOINT, _JOINT_COORDINATES, _LINK, _MOVING_LINK = 7, 6, 9, 16, 21, 27
_NOT_GIVEN = (nan,) * 3


class Owner(Protocol):
    """What a connection is to its bodies; `Client` describes the attributes."""

    world: World
    call_lock: Any
    deformable: bool
    maximal: set[int]


class BodyAccess:
    """Direct access to the state of one body, by the kernels of quick calls.

    Attributes:
        body: The body itself.
        kernels: Calls kernels with numbers after that of the body.
    """

    def __init__(self, client: Owner, body: Body, quick: QuickBodies) -> None:
        self.body = body
        self._world, self._lock = client.world, client.call_lock
        # As in PyBullet, see `Client.maximal`.
        acts_twice = client.deformable and body.id in client.maximal
        self.kernels = quick.kernels_of(body, force_factor=2 if acts_twice else 1)

    @property
    def record(self) -> Record:
        """The body's record for the native library."""
        return self.kernels.record

    def joint_state(self, joint: int) -> JointState:
        """Position, velocity, reaction wrench and motor torque, as `getJointState` returns them."""
        position, velocity, *wrench, torque = self.kernels("joint_state", joint, count=_JOINT)
        return position, velocity, tuple(wrench), torque

    def multi_dof_state(self, joint: int) -> MultiDofState:
        """As `joint_state`, with tuples of positions, velocities and motor torques."""
        numbers = self.kernels("joint_coordinates", joint, count=_JOINT_COORDINATES)
        positions, velocities = self.body.position_count[joint], self.body.velocity_count[joint]
        if positions == velocities == 3:
            # PyBullet reports two of the three coordinates of a planar joint.
            positions = velocities = 2
        return (
            numbers[:positions],
            numbers[4 : 4 + velocities],
            numbers[7:13],
            numbers[13 : 13 + velocities],
        )

    def note_sensor(self, change: Change, joint: int, *, enabled: bool) -> None:
        """Switch the sensor of a joint on or off with a change."""
        self.body.note_sensor(change, joint, enabled=enabled)
        record, shown = self.kernels.joints[joint], c_int32(enabled)
        change.copy_blocks(blank(record, "has_sensor", shown), (record, shown))

    def reset_joint(self, joint: int, position: float, velocity: float) -> None:
        """Set the state of a joint with one degree of freedom, without physics; others stay as they are.

        As in PyBullet, getLinkState returns current poses afterwards.
        """
        with self._lock:
            self._world.prepare_poses()
            self.kernels("reset_joint", joint, position, velocity)

    def link_state(self, link: int, with_velocity: bool) -> LinkState | LinkStateWithVelocity:
        """As `getLinkState` returns it, for the present poses."""
        self._show_links()
        if not with_velocity:
            n = self.kernels("link_state", link, 0, 0, count=_LINK)
            return _state(n)
        self.body.update_link_velocities()
        n = self.kernels("link_state", link, 1, 0, count=_MOVING_LINK)
        return cast(LinkStateWithVelocity, (*_state(n), n[21:24], n[24:27]))

    def _show_links(self) -> None:
        """Let the native library handle calls about links."""
        if not self.record.links:
            self._link_records = link_records(self.body)
            self.record.links = addressof(self._link_records)

    def weighed(self, link: int) -> None:
        """Let the native library handle the next changes of a link's mass; -1 is the base."""
        if self.body.spec.soft is not None:
            return
        from carom.layouts.quick.bodies import Moments
        from carom.scene.dynamics.inertia import shape_terms

        if not self.record.moments:
            self._moments = c_array(Moments, self.body.joint_count + 1)
            self.record.moments = addressof(self._moments)
        if not self._moments[link + 1].is_known:
            write_moments(self._moments[link + 1], shape_terms(self.body, link))

    @cached_property
    def boxes(self) -> Mapping[int, LinkBox | SoftBox]:
        """The bounding boxes of the links, by index, -1 for the base."""
        # Created on demand: most scripts never need the boxes, and these imports are slow.
        from pybullet._access.link_box import LinkBox, SoftBox

        if self.body.spec.soft is not None:
            return {-1: SoftBox(self.body)}
        boxes = {index: LinkBox(self._world, self.body, index) for index in range(-1, self.body.joint_count)}
        self._box_records = box_records(boxes.values())
        self.record.boxes = addressof(self._box_records)
        return boxes

    @cached_property
    def mechanism(self) -> Mechanism | None:
        """The body's equations of motion; None if a joint has more than one degree of freedom."""
        if any(freedoms > 1 for freedoms in self.body.velocity_count):
            return None
        from carom.algorithms.mechanism import mechanism_in_pybullet

        return mechanism_in_pybullet(self.body)

    @cached_property
    def joint_infos(self) -> dict[int, JointInfo]:
        """The return values of `getJointInfo`, by joint index."""
        return {index: joint_info(self.body, index) for index in range(self.body.joint_count)}

    def forget_inertia(self) -> None:
        """Drop only the data that depend on masses and inertias: some scripts change a mass at every step."""
        self.__dict__.pop("mechanism", None)

    def inertial_frame(self, link: int) -> tuple[Vector3, Quaternion]:
        """World pose of a link's inertial frame; -1 is the base."""
        x, y, z, *turn = self.kernels("inertial_frame", link, count=_POSE)
        return (x, y, z), cast(Quaternion, tuple(turn))

    def base_velocity(self) -> tuple[Vector3, Vector3]:
        """Velocity of the base's centre of mass and its angular velocity, in world axes."""
        vx, vy, vz, wx, wy, wz = self.kernels("base_velocity", count=_TWIST)
        return (vx, vy, vz), (wx, wy, wz)

    def place_base(self, position: Vector3, orientation: Quaternion) -> None:
        """Set the pose of the base and its velocity to 0, as `resetBasePositionAndOrientation` does."""
        body, world = self.body, self._world
        with self._lock:
            if body.spec.soft is None:
                world.prepare_poses()
                self.kernels("place_base", *position, *orientation)
                return
            body.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
            world.velocity[body.first_velocity : body.first_velocity + _TWIST] = 0.0
            before = body.coordinates()
            body.set_inertial_pose(position, orientation)
            body.note_reset(moved=body.coordinates() != before)

    def set_base_velocity(self, linear: Vector3 | None, angular: Vector3 | None) -> None:
        """Set velocities of the base, as `resetBaseVelocity` does; None does not change one."""
        body, world = self.body, self._world
        with self._lock:
            if body.spec.soft is None:
                world.prepare_poses()
                self.kernels("set_base_velocity", *(linear or _NOT_GIVEN), *(angular or _NOT_GIVEN))
                return
            present_linear, present_angular = self.base_velocity()
            body.set_base_velocity(linear or present_linear, angular or present_angular)
            body.note_reset(moved=False)
            body.update_link_poses()


def _state(n: tuple[float, ...]) -> LinkState:
    return cast(LinkState, (n[0:3], n[3:7], n[7:10], n[10:14], n[14:17], n[17:21]))


class NoBody(error, KeyError):
    """There is no body of this id, or no more: an argument that was looked at has removed it."""

    __str__ = Exception.__str__


class BodyTable(dict[int, BodyAccess]):
    """Direct access to the bodies of one client, by id; an entry is created on first use.

    The id of a body that does not exist raises `NoBody`.

    Attributes:
        forces_of_motion: The functions for `calculateInverseDynamics`, by body id; a plain dictionary,
            because its look-up is fastest.
        quick: The records of these bodies for the native library.
    """

    __slots__ = ("_client", "forces_of_motion", "quick")

    def __init__(self) -> None:
        super().__init__()
        self.forces_of_motion: dict[int, Ask] = {}
        self._client: ref[Owner]
        self.quick: QuickBodies

    def belong_to(self, client: Owner) -> None:
        """Set the client, once, when it is made."""
        self._client = ref(client)
        self.quick = QuickBodies(client, client.world)

    def forget(self, body_id: int) -> None:
        """Drop the access to a body, because data that it caches change."""
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
        self.quick.hide_all()
        self.clear()
        self.forces_of_motion.clear()

    def __missing__(self, body_id: int) -> BodyAccess:
        client = self._client()
        # Whoever asks has it.
        assert client is not None
        body = client.world.bodies.get(body_id)
        if body is None:
            raise NoBody(no_body(body_id))
        access = BodyAccess(client, body, self.quick)
        self[body_id] = access
        self.quick.show(access.body, access.kernels)
        return access
