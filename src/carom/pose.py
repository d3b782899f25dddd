"""Poses and velocities of frames in the world, as users get them: arrays, of one frame or of many."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.checks import Array, finite
from carom.description.pose import Pose as FramePose

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_NUMBERS = 7
_ORIGIN, _UPRIGHT = np.zeros(3), np.array((0.0, 0.0, 0.0, 1.0))
for _default in (_ORIGIN, _UPRIGHT):
    _default.flags.writeable = False


class _Numbers(NamedTuple):
    position: Array
    orientation: Array


class Pose(_Numbers):
    """Pose of a frame in the world, or poses of many: all arrays may have further axes in front.

    `a * b` is the pose of b, stated in frame a, in the frame that a is stated in.

    Attributes:
        position: Origin of the frame [m], shape (3,) or (..., 3).
        orientation: Unit quaternion (x, y, z, w), shape (4,) or (..., 4); `quaternion` is the same.
    """

    __slots__ = ()

    def __new__(
        cls,
        position: ArrayLike = _ORIGIN,
        quaternion: ArrayLike = _UPRIGHT,
        *,
        orientation: ArrayLike | None = None,
    ) -> Pose:
        """A pose; numbers are converted to arrays. `orientation` is another name of `quaternion`."""
        turn = quaternion if orientation is None else orientation
        return super().__new__(cls, np.asarray(position, np.float64), np.asarray(turn, np.float64))

    def __repr__(self) -> str:
        return f"Pose(position={self.position!r}, quaternion={self.orientation!r})"

    @property
    def quaternion(self) -> Array:
        """The orientation, (..., 4): x, y, z, w."""
        return self.orientation

    @property
    def array(self) -> Array:
        """Position and quaternion in one array, (..., 7)."""
        return np.concatenate([self.position, self.orientation], axis=-1)

    @property
    def rotation(self) -> Array:
        """Rotation matrix, (..., 3, 3): vectors of the frame in the axes of its parent."""
        x, y, z, w = np.moveaxis(self.quaternion, -1, 0)
        rows = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)

    @property
    def matrix(self) -> Array:
        """Homogeneous matrix, (..., 4, 4)."""
        whole = np.zeros((*self.position.shape[:-1], 4, 4))
        whole[..., :3, :3], whole[..., :3, 3], whole[..., 3, 3] = self.rotation, self.position, 1.0
        return whole

    def inverse(self) -> Pose:
        """Pose of the parent in the frame."""
        back = self.quaternion * np.array((-1.0, -1.0, -1.0, 1.0))
        return Pose(-turned(back, self.position), back)

    def __mul__(self, other: Any) -> Pose:  # type: ignore[override]
        if not isinstance(other, tuple | FramePose):
            return NotImplemented
        position, orientation = numbers_of(other)
        return Pose(self.apply(position), product(self.quaternion, orientation))

    def apply(self, points: ArrayLike) -> Array:
        """Points of the frame in its parent.

        Args:
            points: [m], (3,) or (..., 3); with many poses one point, or one for each.
        """
        return turned(self.quaternion, np.asarray(points, dtype=np.float64)) + self.position


class Velocity(NamedTuple):
    """Velocity of a link, or velocities of many, in world axes.

    Attributes:
        linear: Velocity of its centre of mass [m/s], shape (3,) or (..., 3).
        angular: Angular velocity [rad/s], likewise.
    """

    linear: Array
    angular: Array


def numbers_of(pose: Any) -> tuple[Array, Array]:
    """Position and quaternion of what users give as a pose, arrays of finite numbers.

    Args:
        pose: A `Pose`, a position and a quaternion, an array (..., 7) of both, or a list of poses.

    Raises:
        ValueError: It is none of these.
    """
    if isinstance(pose, FramePose):
        pose = (pose.position, pose.orientation)
    if isinstance(pose, list | tuple) and pose and all(isinstance(one, Pose | FramePose) for one in pose):
        parts = [numbers_of(one) for one in pose]
        return np.stack([place for place, _ in parts]), np.stack([turn for _, turn in parts])
    if _is_pair(pose):
        return _vectors(pose[0], 3, "position"), _vectors(pose[1], 4, "orientation")
    both = _vectors(pose, _NUMBERS, "pose, a position and a quaternion,")
    return both[..., :3], both[..., 3:]


def is_pose(given: Any) -> bool:
    """Whether something states a pose, not a position alone."""
    return isinstance(given, FramePose) or _is_pair(given) or np.shape(given)[-1:] == (_NUMBERS,)


def _is_pair(given: Any) -> bool:
    """A tuple of two is one; a list may also be two poses."""
    if isinstance(given, list):
        return len(given) == 2 and np.shape(given[0])[-1:] == (3,)
    return isinstance(given, tuple) and len(given) == 2


def _vectors(value: ArrayLike, length: int, name: str) -> Array:
    """Finite numbers with a last axis of this length."""
    array = finite(value, name)
    if array.shape[-1:] != (length,):
        raise ValueError(f"{name} must have shape ({length},) or (n, {length}), not {array.shape}: {value!r}")
    return array


def turned(quaternion: Array, points: Array) -> Array:
    """Vectors (..., 3) turned by unit quaternions (..., 4)."""
    axis, w = quaternion[..., :3], quaternion[..., 3:]
    twice = 2.0 * np.cross(axis, points)
    return points + w * twice + np.cross(axis, twice)


def product(first: Array, second: Array) -> Array:
    """Product of quaternions (..., 4)."""
    a, b, v, w = first[..., :3], second[..., :3], first[..., 3:], second[..., 3:]
    vector = v * b + w * a + np.cross(a, b)
    return np.concatenate([vector, v * w - (a * b).sum(axis=-1, keepdims=True)], axis=-1)
