"""Log files in PyBullet's layouts.

A binary log is a line of column names, a line of their `struct` types (`I` and `i` 32-bit integers, `f`
32-bit floats), and then records, each preceded by the bytes AA BB.
"""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import c_float
from pathlib import Path
from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np

from pybullet._calls.constants import STATE_LOG_JOINT_MOTOR_TORQUES, STATE_LOG_JOINT_USER_TORQUES
from pybullet._clients.log_file import LogFile
from pybullet._contacts.contacts import getContactPoints

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_BASE_COLUMNS = (("pos", "XYZ"), ("ori", "XYZW"), ("vel", "XYZ"), ("omega", "XYZ"))
_MARKER = b"\xaa\xbb"
ANY_LINK = -2
ANY_BODY = -1


class BinaryLog:
    """Base class of binary logs: named columns, each of one type.

    Raises:
        OSError: The file cannot be written.
    """

    def __init__(self, path: Path, columns: Sequence[str], types: str) -> None:
        self._file = LogFile(path)
        self._file.write(f"{','.join(columns)}\n{types}\n".encode())
        self._pack = Struct(f"<{types}").pack
        self._steps = 0
        self._time = 0.0
        self._start_of_step = (0, 0.0)
        # Records of the present step, written after it. If the step is repeated they are discarded; from a
        # file that is a device they could not be removed.
        self._records: list[bytes] = []

    def before_step(self) -> None:
        """Starts the records of the step."""
        self._records.clear()
        self._start_of_step = (self._steps, self._time)

    def after_step(self) -> None:
        """Writes the records of the substeps to the file."""
        self._file.write(b"".join(self._records))
        self._records.clear()

    def after_substep(self) -> None:
        """Adds the records of a substep."""

    def step_repeated(self) -> None:
        """Discards the records of the step."""
        self._records.clear()
        self._steps, self._time = self._start_of_step

    def close(self) -> None:
        """Finishes the file."""
        self._file.close()

    def _record(self, *values: Any) -> None:
        self._write(self._steps, self._time, *values)

    def _write(self, *values: Any) -> None:
        try:
            packed = self._pack(*values)
        except OverflowError:
            # Numbers too large for single precision become infinite.
            packed = self._pack(*(c_float(v).value if isinstance(v, float) else v for v in values))
        self._records.append(_MARKER + packed)

    def _next(self, time_step: float) -> None:
        self._steps += 1
        self._time += time_step


class RobotLog(BinaryLog):
    """A log of the bases and joints of bodies; without ids, of all bodies.

    For a body with more joints than have columns (`room`), or with a spherical or planar joint, only the
    marker is written, as in PyBullet. `flags` are `STATE_LOG_JOINT_*`, added up.
    """

    def __init__(self, path: Path, world: World, bodies: frozenset[int], room: int, flags: int) -> None:
        self._torques = [0.0] * room if flags > 0 else []
        self._flags = max(flags, 0)
        columns = [f"{name}{axis}" for name, axes in _BASE_COLUMNS for axis in axes]
        joints = [
            f"{letter}{index}" for letter in ("qut" if self._torques else "qu") for index in range(room)
        ]
        super().__init__(
            path,
            ["stepCount", "timeStamp", "objectId", *columns, "qNum", *joints],
            "Ifi" + "f" * len(columns) + "I" + "f" * len(joints),
        )
        self._world = world
        self._bodies = bodies
        self._room = room
        self._torque = self._applied = world.joint_torque.copy()

    def before_step(self) -> None:
        """Copies the torques that the script has applied, because the step clears them."""
        super().before_step()
        self._torque = self._world.joint_torque.copy()
        self._keep_torques()

    def _keep_torques(self) -> None:
        """Computes the applied torques of the next substep, damping included, if they are logged."""
        if self._flags & STATE_LOG_JOINT_USER_TORQUES:
            damping = self._world.arrays.model.numpy["dof_damping"][0, : len(self._torque)]
            self._applied = self._torque - damping * self._world.velocity

    def after_substep(self) -> None:
        """Writes a record for each body."""
        for body in self._world.bodies.values():
            if not self._bodies or body.id in self._bodies:
                self._write_body(body)
        self._keep_torques()
        self._next(self._world.parameters.substep_time)

    def _write_body(self, body: Body) -> None:
        joints = [index for index, freedoms in enumerate(body.velocity_count) if freedoms == 1]
        if len(joints) > self._room or any(freedoms > 1 for freedoms in body.velocity_count):
            self._records.append(_MARKER)
            return
        world = self._world
        q = [body.position_index[joint] for joint in joints]
        u = [body.velocity_index[joint] for joint in joints]
        rest = [0.0] * (self._room - len(joints))
        values = [*world.position[q], *rest, *world.velocity[u], *rest]
        if self._torques:
            torques = np.zeros(len(u))
            if self._flags & STATE_LOG_JOINT_MOTOR_TORQUES:
                torques += world.motor_impulse[u] / world.parameters.substep_time
            if self._flags & STATE_LOG_JOINT_USER_TORQUES:
                torques += self._applied[u]
            values += [*torques, *rest]
        x, y, z, qx, qy, qz, qw = world.position[body.first_position :][:7]
        wx, wy, wz, vx, vy, vz = world.velocity[body.first_velocity :][:6]
        # PyBullet stores the inverse rotation and inverts it again, so its zeros are negative.
        turn = (-(0.0 - qx), -(0.0 - qy), -(0.0 - qz), qw)
        self._record(body.id, x, y, z, *turn, vx, vy, vz, wx, wy, wz, len(joints), *values)


class ContactLog(BinaryLog):
    """A log of the contacts after each substep, of two sides: body (-1 for any) and link (-2 for any)."""

    def __init__(
        self, path: Path, client_id: int, world: World, sides: tuple[tuple[int, int], tuple[int, int]]
    ) -> None:
        columns = (
            "stepCount,timeStamp,contactFlag,bodyUniqueIdA,bodyUniqueIdB,linkIndexA,linkIndexB,"
            "positionOnAX,positionOnAY,positionOnAZ,positionOnBX,positionOnBY,positionOnBZ,"
            "contactNormalOnBX,contactNormalOnBY,contactNormalOnBZ,contactDistance,normalForce"
        )
        super().__init__(path, columns.split(","), "IfIiiii" + "f" * 11)
        self._client_id = client_id
        self._world = world
        self._sides = sides

    def after_substep(self) -> None:
        """Writes a record for each contact."""
        for contact in getContactPoints(physicsClientId=self._client_id):
            flag, a, b, link_a, link_b, on_a, on_b, normal, distance, force = contact[:10]
            if self._asked_for((a, link_a), (b, link_b)):
                self._record(flag, a, b, link_a, link_b, *on_a, *on_b, *normal, distance, force)
        self._next(self._world.parameters.substep_time)

    def _asked_for(self, a: tuple[int, int], b: tuple[int, int]) -> bool:
        first, second = self._sides
        return (_matches(first, a) and _matches(second, b)) or (_matches(first, b) and _matches(second, a))


def _matches(side: tuple[int, int], place: tuple[int, int]) -> bool:
    return side[0] in (ANY_BODY, place[0]) and side[1] in (ANY_LINK, place[1])


class ControllerLog(BinaryLog):
    """A log of virtual reality controllers. These are not supported, so it has no records."""

    def __init__(self, path: Path) -> None:
        columns = "controllerId,numMoveEvents,m_numButtonEvents,posX,posY,posZ,oriX,oriY,oriZ,oriW,analogAxis"
        buttons = [f"buttons{index}" for index in range(7)]
        super().__init__(
            path,
            ["stepCount", "timeStamp", *columns.split(","), *buttons, "deviceType"],
            "IfIIIffffffffIIIIIIII",
        )
