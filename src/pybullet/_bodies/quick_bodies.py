"""The records of a connection's bodies for quick calls.

Each entry of `BodyTable` has a record with the addresses of the body's state. The record is dropped together
with the entry: every operation that moves rows of the state arrays makes the table drop its entries. A record
keeps its arrays alive, so an outdated address could give wrong values, but never point to freed memory.
"""

from __future__ import annotations

import sys
from collections.abc import Collection
from ctypes import Array, addressof, c_void_p
from typing import TYPE_CHECKING, Any

from carom.layouts.quick_bodies import (
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

if TYPE_CHECKING:
    from carom.model.inertia import MassTerms
    from carom.native.quick_calls import QuickCalls
    from pybullet._bodies.body_access import BodyAccess, LinkAccess
    from pybullet._bodies.link_box import LinkBox
    from pybullet._clients.clients import Client as Connection

_DOUBLE = 8
_POSE_ROW, _SPATIAL_ROW, _MOTOR_ROW = (
    numbers * _DOUBLE for numbers in (POSE_NUMBERS, SPATIAL_NUMBERS, MOTOR_NUMBERS)
)
# CPython interns names of attributes.
_TIME_STEP = sys.intern("time_step")
_JOINT_COUNT, _NAMES = sys.intern("joint_count"), sys.intern("_encoded_names")
_FIRST_ROOM = 16
# Python handles bodies whose id is not less than this.
_MAX_ROOM = 1 << 20


class QuickBodies:
    """The records of a connection's bodies for quick calls, by its number; in use until `close`."""

    __slots__ = ("_clients", "_kept", "_number", "_places", "_record", "_shown")

    def __init__(self, calls: QuickCalls, number: int, client: Connection) -> None:
        self._clients = calls.clients
        self._number: int | None = number
        self._places: Array[c_void_p] = (c_void_p * _FIRST_ROOM)()
        # The objects that the addresses in each record point to, by body id.
        self._shown: dict[int, Any] = {}
        self._kept = client.world.quick, client.world.listing
        self._record = Client(
            scene=client.world.quick.address,
            bodies=addressof(self._places),
            body_count=_FIRST_ROOM,
            gate=calls.gates[number],
            connection=id(client),
            time_step_name=id(_TIME_STEP),
            reports_analytics=client.report_analytics,
            world_bodies=id(client.world.listing),
            joint_count_name=id(_JOINT_COUNT),
            encoded_names_name=id(_NAMES),
        )
        self._clients[number] = addressof(self._record)

    def close(self) -> None:
        """Let Python handle all calls for the connection."""
        if self._number is not None:
            self._clients[self._number] = None
            self._number = None

    def report_analytics(self, value: bool) -> None:
        """Tell the native library whether steps return statistics of the solver."""
        self._record.reports_analytics = value

    # A script may end, or unload the module, without disconnecting.
    __del__ = close

    def show(self, access: BodyAccess) -> None:
        """Give the record of a body to the native library, unless Python handles it.

        It does if the body is soft, if external forces act twice on it, and if its id is too high.
        """
        body = access.body
        if body.spec.soft is not None or access.acts_twice or body.id >= _MAX_ROOM:
            return
        state = body.world.arrays.state.struct()
        row = body.first_link
        joints = _joint_records(access)
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
            link_count=body.joint_count,
            tree=body.rows.tree,
            first_link=row,
            dynamics=id(body.all_dynamics),
            handle=id(body),
            derived=id(body.derived),
        )
        access.record = record
        if body.id >= len(self._places):
            self._make_room(body.id + 1)
        self._shown[body.id] = record, access, state, joints, body.all_dynamics, body.derived
        self._places[body.id] = addressof(record)

    def hide(self, body_id: int) -> None:
        """Withdraw the record of a body."""
        if body_id in self._shown:
            self._places[body_id] = None
            del self._shown[body_id]

    def hide_all(self) -> None:
        """Withdraw all records."""
        self._record.body_count = 0
        for body_id in self._shown:
            self._places[body_id] = None
        self._shown.clear()
        self._record.body_count = len(self._places)

    def _make_room(self, count: int) -> None:
        places = (c_void_p * max(count, 2 * len(self._places)))()
        places[: len(self._places)] = self._places[:]
        # While the count is 0, the library finds no bodies, so it never uses a wrong table.
        self._record.body_count = 0
        self._record.bodies = addressof(places)
        self._places = places
        self._record.body_count = len(places)


def _joint_records(access: BodyAccess) -> Array[Joint]:
    body = access.body
    first, first_velocity = body.first_position, body.first_velocity
    return (Joint * body.joint_count)(
        *[
            Joint(
                joint.q - first,
                joint.u - first_velocity,
                freedoms,
                joint.has_sensor,
                joint.motor.lower,
                joint.motor.upper,
            )
            for joint, freedoms in zip(access.joints.values(), body.velocity_count, strict=True)
        ]
    )


def link_records(links: Collection[LinkAccess]) -> Array[Link]:
    """The records of a body's links, except the base, for the native library."""
    records = (Link * len(links))()
    for record, link in zip(records, links, strict=True):
        position, orientation = link.frame
        back = link.from_inertial
        record.inertial_frame[:] = (*position, *orientation)
        record.from_inertial_frame[:] = (*back.position, *back.orientation)
        record.is_turned = link.rotated
    return records


def write_moments(record: Moments, terms: MassTerms) -> None:
    """Write into a record how the moments of inertia of a link depend on its mass."""
    for shown, of_axis in zip(record.terms, terms, strict=True):
        for term, given in zip(shown, of_axis, strict=True):
            term.divisor, term.factors[:] = given.divisor, given.factors
    record.is_known = True


def box_records(boxes: Collection[LinkBox]) -> Array[Box]:
    """The records of the bounding boxes of a body's links, the base first, for the native library."""
    return (Box * len(boxes))(*[Box(box.center, box.half, box.is_moved, box.is_turned) for box in boxes])
