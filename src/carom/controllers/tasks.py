"""Tasks of inverse kinematics: what they want, as rows J dq = e with costs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, not_negative, positive, vector
from carom.controllers.configuration import Configuration
from carom.description.transform import rotation_matrix

_SMALL = 1e-9


class TaskRows(NamedTuple):
    """The rows of a task.

    Attributes:
        error: The change that is missing, (k,).
        jacobian: The change per small change of positions, (k, n).
    """

    error: Array
    jacobian: Array


class Task(ABC):
    """A task.

    Attributes:
        cost: What a unit of the error costs, (k,) or a number; squares of cost times error are added.
        gain: Share of the error to correct in a tick, above 0 and at most 1.
    """

    def __init__(self, cost: ArrayLike, gain: float) -> None:
        self.cost: Array = not_negative(cost, "cost")
        self.gain: float = float(positive(gain, "gain"))
        if self.gain > 1.0:
            raise ValueError(f"gain must be at most 1, not {gain}")

    @abstractmethod
    def rows(self, configuration: Configuration) -> TaskRows:
        """The rows in a configuration."""


class FrameTask(Task):
    """A frame on a link is to reach a pose, in world axes.

    Attributes:
        position: Wanted position of the frame's origin [m], (3,).
        orientation: Wanted orientation, quaternion (x, y, z, w); None if it does not matter.
    """

    def __init__(
        self,
        link: int | str,
        position: ArrayLike,
        orientation: ArrayLike | None = None,
        *,
        offset: ArrayLike = (0.0, 0.0, 0.0),
        position_cost: ArrayLike = 1.0,
        orientation_cost: ArrayLike = 1.0,
        gain: float = 1.0,
    ) -> None:
        """Set the target.

        Args:
            link: Index of the link, -1 for the base, or its name.
            position: [m], (3,).
            orientation: Quaternion (x, y, z, w); None if it does not matter.
            offset: Origin of the frame in the link frame [m], (3,); its axes are those of the link.
            position_cost: Cost of errors [1/m], a number or (3,), for world axes.
            orientation_cost: Cost of errors [1/rad], likewise.
            gain: Share of the error to correct in a tick.
        """
        turned = np.broadcast_to(0.0 if orientation is None else orientation_cost, (3,))
        super().__init__(np.concatenate([np.broadcast_to(position_cost, (3,)), turned]), gain)
        self._link = link
        self._offset = vector(offset, 3, "offset")
        self.position: Array
        self.orientation: Array | None
        self.move(position, orientation)

    def move(self, position: ArrayLike, orientation: ArrayLike | None = None) -> None:
        """Change the target."""
        self.position = vector(position, 3, "position")
        self.orientation = None if orientation is None else vector(orientation, 4, "orientation")
        if self.orientation is not None:
            self._wanted = _matrix(self.orientation)

    def rows(self, configuration: Configuration) -> TaskRows:
        """Displacement and rotation vector to the target, (6,)."""
        rotation, origin = (
            configuration.link_rotation(self._link),
            configuration.link_pose(self._link).position,
        )
        point = origin + rotation @ self._offset
        jacobian = configuration.jacobian(self._link, point if self._offset.any() else None)
        error = np.zeros(6)
        error[:3] = self.position - point
        if self.orientation is not None:
            error[3:] = rotation_vector(self._wanted @ rotation.T)
        return TaskRows(error, jacobian)


class RelativeFrameTask(Task):
    """A frame on a link is to reach a pose relative to another link, in the axes of that one's frame.

    Attributes:
        position: Wanted position of the frame's origin in the frame of the other link [m], (3,).
        orientation: Wanted orientation there, quaternion (x, y, z, w); None if it does not matter.
    """

    def __init__(
        self,
        link: int | str,
        root: int | str,
        position: ArrayLike,
        orientation: ArrayLike | None = None,
        *,
        offset: ArrayLike = (0.0, 0.0, 0.0),
        position_cost: ArrayLike = 1.0,
        orientation_cost: ArrayLike = 1.0,
        gain: float = 1.0,
    ) -> None:
        """Set the target.

        Args:
            link: As in `FrameTask`, also `offset`.
            root: The other link.
            position: [m], (3,), like the orientation in the axes of the other link.
            orientation: Quaternion (x, y, z, w); None if it does not matter.
            offset: Origin of the frame in the link frame [m], (3,); its axes are those of the link.
            position_cost: Cost of errors [1/m], a number or (3,), along the axes of the other link.
            orientation_cost: Cost of errors [1/rad], likewise.
            gain: Share of the error to correct in a tick.
        """
        turned = np.broadcast_to(0.0 if orientation is None else orientation_cost, (3,))
        super().__init__(np.concatenate([np.broadcast_to(position_cost, (3,)), turned]), gain)
        self._link, self._root = link, root
        self._offset = vector(offset, 3, "offset")
        self.position: Array
        self.orientation: Array | None
        self.move(position, orientation)

    def move(self, position: ArrayLike, orientation: ArrayLike | None = None) -> None:
        """Change the target."""
        self.position = vector(position, 3, "position")
        self.orientation = None if orientation is None else vector(orientation, 4, "orientation")
        if self.orientation is not None:
            self._wanted = _matrix(self.orientation)

    def rows(self, configuration: Configuration) -> TaskRows:
        """Displacement and rotation vector to the target in the axes of the other link, (6,)."""
        rotation, base = configuration.link_rotation(self._link), configuration.link_rotation(self._root)
        point = configuration.link_pose(self._link).position + rotation @ self._offset
        relative = base.T @ (point - configuration.link_pose(self._root).position)
        # The other link carries the point along.
        jacobian = configuration.jacobian(self._link, point) - configuration.jacobian(self._root, point)
        error = np.zeros(6)
        error[:3] = self.position - relative
        if self.orientation is not None:
            error[3:] = rotation_vector(self._wanted @ (base.T @ rotation).T)
        return TaskRows(error, (base.T @ jacobian.reshape(2, 3, -1)).reshape(6, -1))


class PostureTask(Task):
    """Joints are to have positions; usually at a low cost, for what the other tasks leave free.

    Attributes:
        target: Wanted positions, in the order of `Configuration.positions`.
    """

    def __init__(self, target: ArrayLike, cost: ArrayLike = 1e-2, gain: float = 1.0) -> None:
        """Set the target, with the cost of errors, a number or one for each velocity of a joint."""
        super().__init__(cost, gain)
        self.target: Array = np.asarray(target, dtype=float).copy()

    def rows(self, configuration: Configuration) -> TaskRows:
        """The changes of joints that lead to the target."""
        first = configuration.base_dofs
        return TaskRows(configuration.difference(self.target)[first:], np.eye(configuration.dofs)[first:])


class DampingTask(Task):
    """Nothing is to move: what other tasks leave free stays, and they are followed more slowly."""

    def __init__(self, cost: ArrayLike) -> None:
        """Set the cost of changes [1/rad or 1/m], a number or one for each velocity."""
        super().__init__(cost, 1.0)

    def rows(self, configuration: Configuration) -> TaskRows:
        """No change of any velocity coordinate, (n,)."""
        return TaskRows(np.zeros(configuration.dofs), np.eye(configuration.dofs))


class CenterOfMassTask(Task):
    """The centre of mass of the body is to reach a point.

    Attributes:
        target: The point in world axes [m], (3,).
    """

    def __init__(self, target: ArrayLike, cost: ArrayLike = 1.0, gain: float = 1.0) -> None:
        """Set the target, with the cost of errors [1/m], a number or (3,); 0 for an axis that is free."""
        super().__init__(cost, gain)
        self.target: Array = vector(target, 3, "target")

    def rows(self, configuration: Configuration) -> TaskRows:
        """The displacement to the target, (3,)."""
        center, jacobian = configuration.center_of_mass()
        return TaskRows(self.target - center, jacobian)


class LookAtTask(Task):
    """An axis of a link is to point at a point in the world, as a camera does.

    Attributes:
        target: The point in world axes [m], (3,).
    """

    def __init__(
        self,
        link: int | str,
        target: ArrayLike,
        *,
        axis: ArrayLike = (0.0, 0.0, 1.0),
        cost: ArrayLike = 1.0,
        gain: float = 1.0,
    ) -> None:
        """Set the target.

        Args:
            link: Index or name of the link, from whose origin it looks.
            target: The point [m], (3,).
            axis: The axis in the link frame, (3,).
            cost: Cost of errors [1/rad].
            gain: Share of the error to correct in a tick.
        """
        super().__init__(cost, gain)
        self._link = link
        self._axis = vector(axis, 3, "axis")
        if not self._axis.any():
            raise ValueError("axis must not be 0")
        self._axis /= np.linalg.norm(self._axis)
        self.target: Array = vector(target, 3, "target")

    def rows(self, configuration: Configuration) -> TaskRows:
        """The rotation vector from the axis to the line of sight, (3,)."""
        rotation, origin = (
            configuration.link_rotation(self._link),
            configuration.link_pose(self._link).position,
        )
        axis, sight = rotation @ self._axis, self.target - origin
        distance = max(float(np.linalg.norm(sight)), _SMALL)
        sight /= distance
        # The rotation vector that turns the axis to the line of sight. If they are opposite, any normal does.
        turn, cosine = np.cross(axis, sight), float(axis @ sight)
        sine = float(np.linalg.norm(turn))
        if sine > _SMALL:
            turn *= np.arctan2(sine, cosine) / sine
        elif cosine < 0.0:
            other = np.eye(3)[int(np.argmin(np.abs(axis)))]
            turn = np.cross(axis, other)
            turn *= np.pi / np.linalg.norm(turn)
        both = configuration.jacobian(self._link)
        # Turns about the axis change nothing; the line of sight turns as the origin moves.
        jacobian = both[3:] - np.outer(axis, axis @ both[3:]) + np.cross(sight, both[:3].T).T / distance
        return TaskRows(turn, jacobian)


def _matrix(quaternion: np.ndarray) -> np.ndarray:
    """The rotation matrix of a quaternion (x, y, z, w) of any norm but 0."""
    norm = float(np.linalg.norm(quaternion))
    if norm == 0.0:
        raise ValueError("orientation must be a quaternion that is not 0")
    x, y, z, w = (quaternion / norm).tolist()
    return np.array(rotation_matrix((x, y, z, w)))


def rotation_vector(matrix: np.ndarray) -> np.ndarray:
    """The rotation vector (3,) [rad] of a rotation matrix."""
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    x, y, z = h - f, c - g, d - b
    sine, cosine = 0.5 * (x * x + y * y + z * z) ** 0.5, 0.5 * (a + e + i - 1.0)
    if sine > 1e-4 or cosine > 0.0:
        scale = 0.5 if sine < _SMALL else 0.5 * np.arctan2(sine, cosine) / sine
        return scale * np.array([x, y, z])
    # Half a turn: the axis is in the symmetric part.
    square = 0.5 * (matrix + np.eye(3))
    column = square[:, int(np.argmax(np.diag(square)))]
    axis = column / np.linalg.norm(column)
    return np.arctan2(sine, cosine) * axis * (1.0 if axis @ (x, y, z) >= 0.0 else -1.0)
