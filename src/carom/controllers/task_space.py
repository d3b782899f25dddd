"""Control of a link in space: operational space control and impedance control."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms import inverse_dynamics, link_motion_derivatives, link_motions, mass_matrix
from carom.checks import Array, finite, not_negative, vector
from carom.controllers.joint_space import JointState
from carom.linearization.turns import cross, cross_matrix, rotation_of
from carom.named_tuples import NamedTuple

if TYPE_CHECKING:
    from carom.scene.body import Body

_ORIGIN = (0.0, 0.0, 0.0)
_AT_REST = (0.0,) * 6
# Directions of less mobility than this share of the greatest are not controlled.
_SINGULAR = 1e-6
# Sines of angles below this are the angles.
_SMALL = 1e-6


class TaskDynamics(NamedTuple):
    """Dynamics of a point on a link, for k = 3 or 6 coordinates, linear before angular, in world axes.

    Attributes:
        jacobian: J, velocity of the task per velocity of joints, (k, n).
        velocity: J v, (k,).
        bias: J̇ v, the acceleration of the task if joints do not accelerate, (k,).
        inertia: Λ = (J M⁻¹ Jᵀ)⁻¹, (k, k); in singular poses without the directions that cannot move.
        mass_matrix: M of the joints, (n, n).
        bias_forces: C v + g of the joints, (n,).
        null_space: N = 1 - Jᵀ Λ J M⁻¹: torques N τ do not accelerate the task, (n, n).
    """

    jacobian: Array
    velocity: Array
    bias: Array
    inertia: Array
    mass_matrix: Array
    bias_forces: Array
    null_space: Array


class TaskSpaceControl:
    """What operational space and impedance control have in common: a point on a link, and a posture."""

    def __init__(
        self,
        body: Body,
        link: int | str,
        *,
        point: ArrayLike = _ORIGIN,
        orientation: bool = True,
        posture: ArrayLike | None = None,
        posture_frequency: ArrayLike = 5.0,
    ) -> None:
        """Choose the point, and what joints do that the task leaves free.

        Args:
            body: A body with a fixed base.
            link: The link by index or name.
            point: The point in the link frame [m], (3,).
            orientation: Whether the orientation is controlled, too.
            posture: Positions of joints that the null space is pulled to; the present ones by default.
            posture_frequency: Natural frequency of this pull, which is critically damped [rad/s], a
                number or (n,).

        Raises:
            ValueError: The base is free, or an argument has a value that it cannot have.
        """
        self._state = JointState(body)
        self._body, self._link = body, body.links[link]
        self._point = vector(point, 3, "point")
        self._rows = 6 if orientation else 3
        present = self._state.read()[0]
        self.posture: Array = (
            present if posture is None else vector(posture, self._state.coordinates, "posture")
        )
        self._frequency = not_negative(posture_frequency, "posture_frequency")
        self._unit = np.eye(self._state.dofs)

    @property
    def pose(self) -> tuple[Array, Array]:
        """Position of the point [m], (3,), and orientation of the link, quaternion (x, y, z, w)."""
        place = self._link.pose
        return place.position + rotation_of(place.orientation) @ self._point, place.orientation

    def dynamics(self) -> TaskDynamics:
        """The dynamics of the task in the present state."""
        positions, velocities = self._state.read()
        none, link = np.zeros(len(velocities)), self._link.index
        jacobian = link_motion_derivatives(self._body, link, positions, velocities, none).dv_dv.copy()
        motion = link_motions(self._body, positions, velocities, none, [link])
        turning, turned = motion.angular_velocities[0], motion.angular_accelerations[0]
        bias = np.empty(6)
        bias[:3], bias[3:] = motion.linear_accelerations[0], turned
        if self._point.any():
            arm = rotation_of(self._link.pose.orientation) @ self._point
            jacobian[:3] -= cross_matrix(arm) @ jacobian[3:]
            bias[:3] += cross(turned, arm) + cross(turning, cross(turning, arm))
        bias, jacobian = bias[: self._rows], jacobian[: self._rows]
        mass = mass_matrix(self._body, positions)
        mobile = np.linalg.solve(mass, jacobian.T)
        inertia = _power(jacobian @ mobile, -1.0, _SINGULAR)
        return TaskDynamics(
            jacobian=jacobian,
            velocity=jacobian @ velocities,
            bias=bias,
            inertia=inertia,
            mass_matrix=mass,
            bias_forces=inverse_dynamics(self._body, positions, velocities, none),
            null_space=self._unit - jacobian.T @ (inertia @ mobile.T),
        )

    def error(self, position: ArrayLike, orientation: ArrayLike | None) -> Array:
        """The displacement [m] and rotation vector [rad] to the wanted pose, in world axes, (3,) or (6,)."""
        place = self._link.pose
        present = place.position + rotation_of(place.orientation) @ self._point
        shift = vector(position, 3, "position") - present
        if self._rows == 3:
            return shift
        found = np.zeros(6)
        found[:3] = shift
        if orientation is not None:
            found[3:] = _turn(vector(orientation, 4, "orientation").tolist(), place.orientation.tolist())
        return found

    def _torques(self, task: TaskDynamics, force: np.ndarray) -> Array:
        """Torques of a force on the task, of the pull to the posture, and against C v + g."""
        positions, velocities = self._state.read()
        pull = self._frequency**2 * self._state.difference(self.posture, positions)
        posture = task.mass_matrix @ (pull - 2.0 * self._frequency * velocities)
        return task.jacobian.T @ force + task.null_space @ posture + task.bias_forces

    def _six(self, value: ArrayLike, name: str) -> Array:
        if value is _AT_REST:
            return np.zeros(self._rows)
        given = finite(value, name)
        return np.broadcast_to(given, (6,))[: self._rows].copy()


class OperationalSpaceControl(TaskSpaceControl):
    """Operational space control (Khatib 1987): a point on a link moves like decoupled masses on springs.

    The error of the task obeys ë + 2 ζ ω ė + ω² e = 0 in each coordinate, whatever the inertia of the robot.
    """

    def __init__(
        self,
        body: Body,
        link: int | str,
        *,
        frequency: ArrayLike = 20.0,
        damping_ratio: ArrayLike = 1.0,
        point: ArrayLike = _ORIGIN,
        orientation: bool = True,
        posture: ArrayLike | None = None,
        posture_frequency: ArrayLike = 5.0,
    ) -> None:
        """Make a controller.

        Args:
            body: A body with a fixed base.
            link: The link by index or name.
            frequency: Natural frequency ω of the error [rad/s], a number or (6,), linear before angular.
            damping_ratio: ζ, likewise; 1 is critical.
            point: As in `TaskSpaceControl`, also the arguments after it.
            orientation: Whether the orientation is controlled, too.
            posture: Positions of joints that the null space is pulled to; the present ones by default.
            posture_frequency: Natural frequency of this pull, which is critically damped [rad/s], a
                number or (n,).

        Raises:
            ValueError: The base is free, or an argument has a value that it cannot have.
        """
        options = {"point": point, "orientation": orientation, "posture": posture}
        super().__init__(body, link, posture_frequency=posture_frequency, **options)  # type: ignore[arg-type]
        self._omega = self._six(not_negative(frequency, "frequency"), "frequency")
        self._zeta = self._six(not_negative(damping_ratio, "damping_ratio"), "damping_ratio")

    def compute(
        self,
        position: ArrayLike,
        orientation: ArrayLike | None = None,
        *,
        velocity: Sequence[float] | np.ndarray = _AT_REST,
        acceleration: Sequence[float] | np.ndarray = _AT_REST,
    ) -> Array:
        """The torques or forces of joints for the next step, for `body.joints.set_torques`, (n,) [N m or N].

        Args:
            position: Wanted position of the point [m], (3,).
            orientation: Wanted orientation of the link, quaternion (x, y, z, w); None only damps turns.
            velocity: Wanted velocity, linear before angular, in world axes, (6,).
            acceleration: Wanted acceleration, likewise.

        Raises:
            ValueError: A shape does not fit, or a number is not finite.
        """
        task = self.dynamics()
        rates = self._six(velocity, "velocity") - task.velocity
        motion = self._six(acceleration, "acceleration") + 2.0 * self._zeta * self._omega * rates
        motion = motion + self._omega**2 * self.error(position, orientation)
        return self._torques(task, task.inertia @ (motion - task.bias))


class ImpedanceControl(TaskSpaceControl):
    """Impedance control (Hogan 1985): a point on a link reacts to forces like a damped mass on a spring.

    With an external force F the error obeys Λ ë + D ė + K e = -F, where Λ is the inertia that the robot has
    there, so no measurement of forces is needed.
    """

    def __init__(
        self,
        body: Body,
        link: int | str,
        *,
        stiffness: ArrayLike = (400.0, 400.0, 400.0, 20.0, 20.0, 20.0),
        damping_ratio: float = 1.0,
        point: ArrayLike = _ORIGIN,
        orientation: bool = True,
        posture: ArrayLike | None = None,
        posture_frequency: ArrayLike = 5.0,
    ) -> None:
        """Make a controller.

        Args:
            body: A body with a fixed base.
            link: The link by index or name.
            stiffness: K in world axes: a number, (6,) or (3,) for its diagonal, or a symmetric matrix of as
                many rows as the task has [N/m and N m/rad].
            damping_ratio: D damps all modes of Λ and K with this ratio; 1 is critical.
            point: As in `TaskSpaceControl`, also the arguments after it.
            orientation: Whether the orientation is controlled, too.
            posture: Positions of joints that the null space is pulled to; the present ones by default.
            posture_frequency: Natural frequency of this pull, which is critically damped [rad/s], a
                number or (n,).

        Raises:
            ValueError: The base is free, or an argument has a value that it cannot have.
        """
        options = {"point": point, "orientation": orientation, "posture": posture}
        super().__init__(body, link, posture_frequency=posture_frequency, **options)  # type: ignore[arg-type]
        given = finite(stiffness, "stiffness")
        if given.ndim < 2:
            given = np.diag(np.broadcast_to(given, (max(given.size, self._rows),))[: self._rows])
        if given.shape != (self._rows, self._rows) or not np.allclose(given, given.T):
            raise ValueError(f"stiffness must be a symmetric matrix of {self._rows} rows, or its diagonal")
        if np.linalg.eigvalsh(given)[0] < 0.0:
            raise ValueError("stiffness must not have negative eigenvalues")
        self._stiffness = given
        self._zeta = float(not_negative(damping_ratio, "damping_ratio"))

    def compute(
        self,
        position: ArrayLike,
        orientation: ArrayLike | None = None,
        *,
        velocity: Sequence[float] | np.ndarray = _AT_REST,
        acceleration: Sequence[float] | np.ndarray = _AT_REST,
        force: Sequence[float] | np.ndarray = _AT_REST,
    ) -> Array:
        """The torques or forces of joints for the next step, for `body.joints.set_torques`, (n,) [N m or N].

        Args:
            position: As in `OperationalSpaceControl.compute`, also the next three.
            orientation: Wanted orientation of the link, quaternion (x, y, z, w); None only damps turns.
            velocity: Wanted velocity, linear before angular, in world axes, (6,).
            acceleration: Wanted acceleration, likewise.
            force: Force and torque to exert on what the point touches, (6,) [N and N m].

        Raises:
            ValueError: A shape does not fit, or a number is not finite.
        """
        task = self.dynamics()
        rates = self._six(velocity, "velocity") - task.velocity
        pull = self._stiffness @ self.error(position, orientation) + self._damping(task.inertia) @ rates
        motion = task.inertia @ (self._six(acceleration, "acceleration") - task.bias)
        return self._torques(task, pull + motion + self._six(force, "force"))

    def _damping(self, inertia: np.ndarray) -> Array:
        """D = 2 ζ √Λ √(√Λ⁻¹ K √Λ⁻¹) √Λ."""
        values, vectors = np.linalg.eigh(inertia)
        sizes = np.sqrt(np.maximum(values, 0.0))
        held = sizes > np.sqrt(_SINGULAR) * sizes[-1]
        root = (vectors * sizes) @ vectors.T
        back = (vectors * np.where(held, 1.0 / np.where(held, sizes, 1.0), 0.0)) @ vectors.T
        return 2.0 * self._zeta * (root @ _power(back @ self._stiffness @ back, 0.5, 0.0) @ root)


def _power(matrix: np.ndarray, exponent: float, least: float) -> Array:
    """A power of a symmetric matrix without negative eigenvalues, in the directions where it is not 0.

    Args:
        matrix: The matrix.
        exponent: The exponent.
        least: Eigenvalues of no more than this share of the greatest count as 0.
    """
    values, vectors = np.linalg.eigh(matrix)
    if values[0] > least * values[-1]:
        return (vectors * values**exponent) @ vectors.T
    there = values > max(least * values[-1], 0.0)
    powers = np.where(there, np.where(there, values, 1.0) ** exponent, 0.0)
    return (vectors * powers) @ vectors.T


def _turn(wanted: list[float], present: list[float]) -> tuple[float, float, float]:
    """The rotation vector [rad] in world axes from a unit quaternion (x, y, z, w) to another of any norm."""
    ax, ay, az, aw = wanted
    bx, by, bz, bw = present
    x = bw * ax - aw * bx - ay * bz + az * by
    y = bw * ay - aw * by - az * bx + ax * bz
    z = bw * az - aw * bz - ax * by + ay * bx
    w = aw * bw + ax * bx + ay * by + az * bz
    sine, sign = math.sqrt(x * x + y * y + z * z), -1.0 if w < 0.0 else 1.0
    norm = math.hypot(sine, w)
    if norm == 0.0:
        raise ValueError("orientation must be a quaternion that is not 0")
    per_sine = 1.0 / norm if sine < _SMALL * norm else math.atan2(sine, sign * w) / sine
    scale = 2.0 * sign * per_sine
    return scale * x, scale * y, scale * z
