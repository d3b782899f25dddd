"""The state of bodies in a file of Bullet: what `restoreState` of PyBullet takes from it."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from pathlib import Path

from carom.errors import DescriptionError
from carom.formats.bullet.chunks import MAGIC, BulletFile, Item
from carom.formats.bullet.structures import Damaged

_MULTI_BODY, _RIGID_BODY = b"MBDY", b"RBDY"
_COORDINATES, _VELOCITIES = 7, 6
# Numbers beyond this are none that a simulation arrives at.
_LARGEST = 1e15
_UNIT_TOLERANCE = 1e-3
_OBJECT, _PLACE = "m_collisionObjectData", "m_worldTransform"
_ROW = 4

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class LinkState:
    """Coordinates of the joint of a link [m, rad, or a quaternion xyzw] and velocities [m/s, rad/s]."""

    position: tuple[float, ...]
    velocity: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class MultiBodyState:
    """State of a body with reduced coordinates.

    Attributes:
        position: Centre of mass of the base [m], world axes.
        orientation: Of the base's inertial frame, quaternion xyzw.
        linear: Velocity of the centre of mass [m/s].
        angular: Angular velocity [rad/s], world axes.
        links: State of each link, in the order of link indices.
    """

    position: Vector
    orientation: Quaternion
    linear: Vector
    angular: Vector
    links: tuple[LinkState, ...]


@dataclass(frozen=True, slots=True)
class RigidBodyState:
    """State of a body with maximal coordinates; fields as in `MultiBodyState`.

    Attributes:
        number: Number of its proxy in the broad phase, which grows in order of creation.
    """

    number: int
    position: Vector
    orientation: Quaternion
    linear: Vector
    angular: Vector


@dataclass(frozen=True, slots=True)
class BulletState:
    """State of all bodies: those with reduced coordinates in Bullet's order, the others by creation."""

    multi_bodies: tuple[MultiBodyState, ...]
    rigid_bodies: tuple[RigidBodyState, ...]


def is_bullet(data: bytes) -> bool:
    """Whether the content of a file begins as Bullet's do."""
    return data[: len(MAGIC)] == MAGIC


def read_bullet_state(data: bytes, file: Path) -> BulletState:
    """The state of the bodies in the content of a file, whose path is for error messages.

    Files of either precision, size of pointers and order of bytes can be read.

    Raises:
        DescriptionError: It is not a file of Bullet, or is damaged.
    """
    try:
        content = BulletFile(data)
        multi, rigid = (
            [item for chunk in content.chunks if chunk.code == code for item in content.items(chunk)]
            for code in (_MULTI_BODY, _RIGID_BODY)
        )
        bodies = sorted(map(_rigid_body, rigid), key=lambda body: body.number)
        return BulletState(tuple(map(_multi_body, multi)), tuple(bodies))
    except Damaged as problem:
        raise DescriptionError(f"this file of Bullet cannot be used: {problem}", file=file) from problem


def _multi_body(item: Item) -> MultiBodyState:
    x, y, z, w = _unit(_numbers(item, 4, "m_baseWorldOrientation"), "m_baseWorldOrientation")
    count = item.integer("m_numLinks")
    if count < 0:
        raise Damaged(f"a body has {count} links")
    return MultiBodyState(
        _vector(item, "m_baseWorldPosition"),
        (x, y, z, w),
        _vector(item, "m_baseLinearVelocity"),
        _vector(item, "m_baseAngularVelocity"),
        tuple(map(_link, item.pointed("m_links", count))) if count else (),
    )


def _link(item: Item) -> LinkState:
    positions, velocities = item.integer("m_posVarCount"), item.integer("m_dofCount")
    if not (0 <= positions <= _COORDINATES and 0 <= velocities <= _VELOCITIES):
        raise Damaged(f"a joint has {positions} coordinates and {velocities} velocities")
    position = _numbers(item, positions, "m_jointPos")
    if positions == 4:
        position = _unit(position, "m_jointPos")
    return LinkState(position, _numbers(item, velocities, "m_jointVel"))


def _rigid_body(item: Item) -> RigidBodyState:
    matrix = _numbers(item, 3 * _ROW, _OBJECT, _PLACE, "m_basis", "m_el")
    rows = tuple(matrix[start : start + 3] for start in (0, _ROW, 2 * _ROW))
    return RigidBodyState(
        item.integer(_OBJECT, "m_uniqueId"),
        _vector(item, _OBJECT, _PLACE, "m_origin"),
        _unit(_quaternion(rows), "m_basis"),
        _vector(item, "m_linearVelocity"),
        _vector(item, "m_angularVelocity"),
    )


def _numbers(item: Item, count: int, *path: str) -> tuple[float, ...]:
    numbers = item.numbers(path, count) if count else ()
    if not all(isfinite(number) and abs(number) <= _LARGEST for number in numbers):
        raise Damaged(f"{path[-1]} has a number that is infinite, NaN or very large")
    return numbers


def _vector(item: Item, *path: str) -> Vector:
    x, y, z = _numbers(item, 3, *path)
    return x, y, z


def _unit(turn: tuple[float, ...], name: str) -> Quaternion:
    x, y, z, w = turn
    if abs(x * x + y * y + z * z + w * w - 1.0) > _UNIT_TOLERANCE:
        raise Damaged(f"{name} is not a rotation")
    return x, y, z, w


def _quaternion(rows: tuple[tuple[float, ...], ...]) -> Quaternion:
    """The quaternion of a rotation matrix; its largest component is computed first, so that none is lost."""
    (a, b, c), (d, e, f), (g, h, i) = rows
    squares = (1.0 + a - e - i, 1.0 - a + e - i, 1.0 - a - e + i, 1.0 + a + e + i)
    largest = max(range(4), key=squares.__getitem__)
    # Four times the products of the largest component with all four, among them its own square.
    products = (
        (squares[0], b + d, c + g, h - f),
        (b + d, squares[1], f + h, c - g),
        (c + g, f + h, squares[2], d - b),
        (h - f, c - g, d - b, squares[3]),
    )[largest]
    scale = 0.5 / squares[largest] ** 0.5
    x, y, z, w = (product * scale for product in products)
    return x, y, z, w
