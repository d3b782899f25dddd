"""The records of a connection's bodies for quick calls.

Each entry of `BodyTable` has a record with the addresses of the body's state. The record is dropped together
with the entry: every operation that moves rows of the state arrays makes the table drop its entries. A record
keeps its arrays alive, so an outdated address could give wrong values, but never point to freed memory.
"""

from __future__ import annotations

import sys
from collections.abc import Collection
from ctypes import Array, addressof, c_void_p
from math import inf
from typing import TYPE_CHECKING, Any

from carom.description.transform import inverse
from carom.layouts.codes import SENSED
from carom.layouts.quick.bodies import (
    MOTOR_NUMBERS,
    POSE_NUMBERS,
    SPATIAL_NUMBERS,
    Body,
    Box,
    Client,
    Joint,
    Link,
    Moments,
)
from carom.layouts.quick.calls import Call
from carom.native.arrays import c_array
from carom.native.number_kernels import worked_out

if TYPE_CHECKING:
    from carom.description.shapes.moments import MassTerms
    from carom.native.quick_calls import QuickCalls
    from carom.scene.body import Body as SceneBody
    from carom.scene.core.world_core import WorldCore
    from pybullet._access.link_box import LinkBox

_DOUBLE = 8
_POSE_ROW, _SPATIAL_ROW, _MOTOR_ROW = (
    numbers * _DOUBLE for numbers in (POSE_NUMBERS, SPATIAL_NUMBERS, MOTOR_NUMBERS)
)
_NO_TURN = (0.0, 0.0, 0.0, 1.0)
# CPython interns names of attributes.
_JOINT_COUNT, _NAMES = sys.intern("joint_count"), sys.intern("_encoded_names")
_FIRST_ROOM = 16
# Python handles bodies whose id is not less than this.
_MAX_ROOM = 1 << 20


class BodyKernels:
    """Calls kernels of quick calls on a body.

    Attributes:
        record: The body's record.
        joints: Those of its joints.
    """

    __slots__ = ("_address", "_kept", "joints", "record")

    def __init__(self, client: Client, record: Body, joints: Array[Joint], *kept: Any) -> None:
        call = Call(client=addressof(client), body=addressof(record))
        self.record, self.joints = record, joints
        self._kept = client, call, kept
        self._address = addressof(call)

    def __call__(self, kernel: str, *numbers: float, count: int = 0) -> tuple[float, ...]:
        """The results, so many, of a kernel for the numbers that follow the body among its arguments."""
        results = worked_out(kernel, (0.0, *numbers), count, self._address)
        assert results is not None, kernel
        return results


class QuickBodies:
    """The records of a connection and its bodies.

    Attributes:
        record: The record of the connection.
    """

    __slots__ = ("_clients", "_kept", "_number", "_places", "_shown", "record")

    def __init__(self, connection: object, world: WorldCore) -> None:
        self._clients: Any = None
        self._number: int | None = None
        self._places: Array[c_void_p] = c_array(c_void_p, _FIRST_ROOM)
        # What calls the kernels of each body, and keeps alive what its record points to, by body id.
        self._shown: dict[int, BodyKernels] = {}
        self._kept = world.quick, world.listing
        self.record: Any = Client(
            scene=world.quick.address,
            bodies=addressof(self._places),
            body_count=_FIRST_ROOM,
            connection=id(connection),
            world_bodies=id(world.listing),
            joint_count_name=id(_JOINT_COUNT),
            encoded_names_name=id(_NAMES),
        )

    def open(self, calls: QuickCalls, number: int) -> None:
        """Let the native library handle calls for the connection of this number, until `close`."""
        self.record.gate = calls.gates[number]
        self._clients, self._number = calls.clients, number
        self._clients[number] = addressof(self.record)

    def close(self) -> None:
        """Let Python handle all calls for the connection."""
        if self._number is not None:
            self._clients[self._number] = None
            self._number = None

    # A script may end, or unload the module, without disconnecting.
    __del__ = close

    def kernels_of(self, body: SceneBody, force_factor: int) -> BodyKernels:
        """What calls kernels on a body, on which external forces act so many times."""
        state = body.world.arrays.state.struct()
        row = body.first_link
        joints = _joint_records(body)
        record = Body(
            position=state.position.data + body.first_position * _DOUBLE,
            velocity=state.dof_velocity.data + body.first_velocity * _DOUBLE,
            pose=state.link_pose.data + row * _POSE_ROW,
            twist=state.link_twist.data + row * _SPATIAL_ROW,
            wrench=state.link_wrench.data + row * _SPATIAL_ROW,
            motor=state.dof_motor.data + body.first_velocity * _MOTOR_ROW,
            pd=state.dof_pd.data + body.first_velocity * _MOTOR_ROW,
            torque=state.dof_torque.data + body.first_velocity * _DOUBLE,
            motor_impulse=state.dof_motor_impulse.data + body.first_velocity * _DOUBLE,
            reaction=state.link_reaction.data + row * _SPATIAL_ROW,
            joints=addressof(joints),
            position_count=body.rows.count["position"],
            velocity_count=body.rows.count["dof"],
            force_factor=force_factor,
            link_count=body.joint_count,
            tree=body.rows.tree,
            first_link=row,
            dynamics=id(body.all_dynamics),
            handle=id(body),
            derived=id(body.derived),
        )
        return BodyKernels(self.record, record, joints, body, state, body.all_dynamics, body.derived)

    def show(self, body: SceneBody, kernels: BodyKernels) -> None:
        """Give the record of a body to the native library, unless it is soft or its id is too high."""
        if body.spec.soft is not None or body.id >= _MAX_ROOM:
            return
        if body.id >= len(self._places):
            self._make_room(body.id + 1)
        self._shown[body.id] = kernels
        self._places[body.id] = addressof(kernels.record)

    def hide(self, body_id: int) -> None:
        """Withdraw the record of a body."""
        if body_id in self._shown:
            self._places[body_id] = None
            del self._shown[body_id]

    def hide_all(self) -> None:
        """Withdraw all records."""
        self.record.body_count = 0
        for body_id in self._shown:
            self._places[body_id] = None
        self._shown.clear()
        self.record.body_count = len(self._places)

    def _make_room(self, count: int) -> None:
        places = c_array(c_void_p, max(count, 2 * len(self._places)))
        places[: len(self._places)] = self._places[:]
        # While the count is 0, the library finds no bodies, so it never uses a wrong table.
        self.record.body_count = 0
        self.record.bodies = addressof(places)
        self._places = places
        self.record.body_count = len(places)


def _joint_records(body: SceneBody) -> Array[Joint]:
    records, sensors = c_array(Joint, body.joint_count), body.measured_joints
    for index, record in enumerate(records):
        dynamics = body.dynamics(index)
        lower, upper = dynamics.joint_lower_limit, dynamics.joint_upper_limit
        record.position = body.position_index[index] - body.first_position
        record.velocity = body.velocity_index[index] - body.first_velocity
        record.position_count = body.position_count[index]
        record.dof_count = body.velocity_count[index]
        record.has_sensor = sensors[index] & SENSED
        # Without limits the lower one is greater.
        record.lower, record.upper = (lower, upper) if lower <= upper else (-inf, inf)
    return records


def link_records(body: SceneBody) -> Array[Link]:
    """The records of a body's links, except the base, for the native library."""
    records = c_array(Link, body.joint_count)
    for index, record in enumerate(records):
        frame = body.link_inertial_frame(index)
        back = inverse(frame)
        record.inertial_frame[:] = (*frame.position, *frame.orientation)
        record.from_inertial_frame[:] = (*back.position, *back.orientation)
        record.is_turned = back.orientation != _NO_TURN
    return records


def write_moments(record: Moments, terms: MassTerms) -> None:
    """Write into a record how the moments of inertia of a link depend on its mass."""
    for shown, of_axis in zip(record.terms, terms, strict=True):
        for term, given in zip(shown, of_axis, strict=True):
            term.divisor, term.factors[:] = given.divisor, given.factors
    record.is_known = True


def box_records(boxes: Collection[LinkBox]) -> Array[Box]:
    """The records of the bounding boxes of a body's links, the base first, for the native library."""
    return c_array(Box, len(boxes), [Box(box.center, box.half, box.is_moved, box.is_turned) for box in boxes])
