"""Logs of episodes in the format that PyBullet's Minitaur writes, a Protocol Buffers message.

The format is small enough to be read and written here, without a library. Fields by number:

- `MinitaurEpisode`: 1 repeated `MinitaurStateAction`
- `MinitaurStateAction`: 1 time, 2 base_position, 3 base_orientation, 4 base_angular_vel, 5 repeated
  `MinitaurMotorState`, 6 bool info_valid
- `MinitaurMotorState`: doubles 1 angle, 2 velocity, 3 torque, 4 action
- time: integers 1 seconds, 2 nanos; vectors: doubles 1 x, 2 y, 3 z
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from typing_extensions import Self

NUM_MOTORS = 8
_INTEGER, _DOUBLE, _MESSAGE = 0, 1, 2
_MOST_BITS = 63
_DOUBLE_LAYOUT = struct.Struct("<d")


@dataclass
class Timestamp:
    """A time: seconds and billionths of a second."""

    seconds: int = 0
    nanos: int = 0

    def _encoded(self) -> bytes:
        return _integer(1, self.seconds) + _integer(2, self.nanos)

    @classmethod
    def _decoded(cls, data: bytes) -> Timestamp:
        return cls(*_numbers(data, 2))


class _Doubles:
    """A message of nothing but doubles, numbered as the fields of the class are ordered."""

    def _encoded(self) -> bytes:
        return b"".join(_double(number, value) for number, value in enumerate(vars(self).values(), 1))

    @classmethod
    def _decoded(cls, data: bytes) -> Self:
        return cls(*map(float, _numbers(data, len(cls.__annotations__))))


@dataclass
class Vector3d(_Doubles):
    """Three numbers."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass
class MinitaurMotorState(_Doubles):
    """A motor: angle [rad], velocity [rad/s], torque [N m], and what it was commanded."""

    angle: float = 0.0
    velocity: float = 0.0
    torque: float = 0.0
    action: float = 0.0


@dataclass
class MinitaurStateAction:
    """A step: its time, the base's position [m], Euler angles [rad] and angular velocity [rad/s], motors."""

    time: Timestamp = field(default_factory=Timestamp)
    base_position: Vector3d = field(default_factory=Vector3d)
    base_orientation: Vector3d = field(default_factory=Vector3d)
    base_angular_vel: Vector3d = field(default_factory=Vector3d)
    motor_states: list[MinitaurMotorState] = field(default_factory=list)
    info_valid: bool = False

    @classmethod
    def empty(cls) -> MinitaurStateAction:
        """A step of which nothing is known yet."""
        return cls(motor_states=[MinitaurMotorState() for _ in range(NUM_MOTORS)])

    def _encoded(self) -> bytes:
        parts = (self.time, self.base_position, self.base_orientation, self.base_angular_vel)
        numbered = [*enumerate(parts, 1), *((5, motor) for motor in self.motor_states)]
        messages = b"".join(_message(number, part._encoded()) for number, part in numbered)
        return messages + _integer(6, int(self.info_valid))

    @classmethod
    def _decoded(cls, data: bytes) -> MinitaurStateAction:
        found = list(_fields(data))
        single: dict[int, Any] = dict(found)
        return cls(
            Timestamp._decoded(single.get(1, b"")),
            Vector3d._decoded(single.get(2, b"")),
            Vector3d._decoded(single.get(3, b"")),
            Vector3d._decoded(single.get(4, b"")),
            [MinitaurMotorState._decoded(value) for number, value in found if number == 5],
            bool(single.get(6, 0)),
        )


@dataclass
class MinitaurEpisode:
    """The steps of an episode."""

    state_action: list[MinitaurStateAction] = field(default_factory=list)

    @classmethod
    def of_steps(cls, count: int) -> MinitaurEpisode:
        """Room for so many steps."""
        return cls([MinitaurStateAction.empty() for _ in range(count)])

    def SerializeToString(self) -> bytes:
        """The bytes of a log."""
        return b"".join(_message(1, step._encoded()) for step in self.state_action)

    def ParseFromString(self, serialized: bytes) -> int:
        """Reads the bytes of a log, in place of what was here; tells how many there were.

        Raises:
            ValueError: They are no log.
        """
        self.state_action = [
            MinitaurStateAction._decoded(value) for number, value in _fields(serialized) if number == 1
        ]
        return len(serialized)


def _varint(value: int) -> bytes:
    """An integer in groups of seven bits, the lowest first."""
    groups = bytearray()
    while value > 0x7F:
        groups.append(value & 0x7F | 0x80)
        value >>= 7
    groups.append(value)
    return bytes(groups)


def _integer(number: int, value: int) -> bytes:
    """A field; zeros are left out, as the format has it."""
    return _varint(number << 3 | _INTEGER) + _varint(value) if value else b""


def _double(number: int, value: float) -> bytes:
    """A field; zeros are left out."""
    return _varint(number << 3 | _DOUBLE) + _DOUBLE_LAYOUT.pack(value) if value else b""


def _message(number: int, data: bytes) -> bytes:
    return _varint(number << 3 | _MESSAGE) + _varint(len(data)) + data


def _numbers(data: bytes, count: int) -> list[Any]:
    """The values of the fields from 1 to a count; 0 for those that were left out.

    Raises:
        ValueError: One of them is no number.
    """
    found = dict(_fields(data))
    values = [found.get(number, 0) for number in range(1, count + 1)]
    if any(isinstance(value, bytes) for value in values):
        raise ValueError("the log has a message where a number should be")
    return values


def _fields(data: Any) -> Iterator[tuple[int, Any]]:
    """Numbers and values of all fields.

    Raises:
        ValueError: The data is no message, ends within a field, or has one of another kind.
    """
    if not isinstance(data, bytes):
        raise ValueError("the log has a number where a message should be")
    place = 0

    def taken(count: int) -> bytes:
        nonlocal place
        piece = data[place : place + count]
        if len(piece) < count:
            raise ValueError(f"the log ends within a field, at byte {len(data)} of a message")
        place += count
        return piece

    def varint() -> int:
        value, shift = 0, 0
        while (group := taken(1)[0]) & 0x80:
            value |= (group & 0x7F) << shift
            shift += 7
            if shift > _MOST_BITS:
                raise ValueError("the log has an integer of more than 64 bits")
        return value | group << shift

    while place < len(data):
        number, kind = divmod(varint(), 8)
        if kind == _INTEGER:
            yield number, varint()
        elif kind == _DOUBLE:
            yield number, _DOUBLE_LAYOUT.unpack(taken(_DOUBLE_LAYOUT.size))[0]
        elif kind == _MESSAGE:
            yield number, taken(varint())
        else:
            raise ValueError(f"field {number} of the log is of kind {kind}")
