"""Control of a link in space: operational space control and impedance control."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from struct import error as StructError
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.algorithms.not_finite import not_finite
from carom.checks import Array, finite, not_negative, vector
from carom.controllers.joint_space import JointState
from carom.controllers.task_memory import TaskMemory
from carom.linearization.turns import rotation_of
from carom.native.gates import gated

if TYPE_CHECKING:
    from carom.scene.body import Body

_ORIGIN = (0.0, 0.0, 0.0)
_AT_REST = (0.0,) * 6


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


class TaskSpaceControl(ABC):
    """What operational space and impedance control have in common: a point on a link, and a posture."""

    _spring: ClassVar[bool] = False

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
        self._memory: TaskMemory | None = None

    @property
    def pose(self) -> tuple[Array, Array]:
        """Position of the point [m], (3,), and orientation of the link, quaternion (x, y, z, w)."""
        place = self._link.pose
        return place.position + rotation_of(place.orientation) @ self._point, place.orientation

    @gated("_body.world.call_lock")
    def dynamics(self) -> TaskDynamics:
        """The dynamics of the task in the present state.

        Raises:
            ValueError: It is not finite, as for a joint that moves nothing with inertia.
        """
        memory = self._answer(self.pose[0], None)
        rows, dofs = self._rows, self._state.dofs
        mass = memory.mechanism.arrays["matrix"][: dofs * dofs].reshape(dofs, dofs).copy()
        jacobian = memory.arrays["column_jacobian"][: rows * dofs].reshape(rows, dofs).copy()
        inertia = memory.of_task("inertia", rows, rows)
        mobile = np.linalg.solve(mass, jacobian.T)
        return TaskDynamics(
            jacobian=jacobian,
            velocity=memory.of_task("velocity", rows),
            bias=memory.of_task("bias", rows),
            inertia=inertia,
            mass_matrix=mass,
            bias_forces=memory.mechanism.arrays["output"][:dofs].copy(),
            null_space=np.eye(dofs) - jacobian.T @ (inertia @ mobile.T),
        )

    @gated("_body.world.call_lock")
    def error(self, position: ArrayLike, orientation: ArrayLike | None) -> Array:
        """The displacement [m] and rotation vector [rad] to the wanted pose, in world axes, (3,) or (6,)."""
        return self._answer(position, orientation).of_task("error", self._rows)

    @abstractmethod
    def _gains(self) -> dict[str, Array]:
        """The gains that `TaskMemory.set_gains` takes besides those of all kinds of control."""

    def _answer(
        self,
        position: Any,
        orientation: Any,
        velocity: Any = _AT_REST,
        acceleration: Any = _AT_REST,
        force: Any = _AT_REST,
    ) -> TaskMemory:
        """The memory after the kernel has run for these targets; the caller holds the lock of the world."""
        memory = self._memory
        if memory is None or memory.outdated:
            memory = TaskMemory(self._body, self._link.index, self._rows, spring=self._spring)
            memory.set_gains(point=self._point, posture_frequency=self._frequency, **self._gains())
            self._memory = memory
        try:
            memory.write_targets(position, orientation, velocity, acceleration, force)
        except (TypeError, ValueError, StructError):
            memory.write_targets(*self._checked(position, orientation, velocity, acceleration, force))
        memory.take_state()
        if self._state.plain:
            np.subtract(self.posture, memory.positions, out=memory.pull)
        else:
            memory.pull[:] = self._state.difference(self.posture, memory.positions)
        memory.run()
        if not memory.is_finite:
            self._checked(position, orientation, velocity, acceleration, force)
            finite(self.posture, "posture")
            raise not_finite(self._body, *self._state.read())
        return memory

    def _checked(
        self, position: Any, orientation: Any, velocity: Any, acceleration: Any, force: Any
    ) -> tuple[Array, Array | None, Array, Array, Array]:
        """The targets as arrays; raises `ValueError` if one cannot be used."""
        turn = None if orientation is None else vector(orientation, 4, "orientation")
        if turn is not None and not turn.any():
            raise ValueError("orientation must be a quaternion that is not 0")
        place = vector(position, 3, "position")
        return (
            place,
            turn,
            _six(velocity, "velocity"),
            _six(acceleration, "acceleration"),
            _six(force, "force"),
        )


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
        self._omega = _six(not_negative(frequency, "frequency"), "frequency")
        self._zeta = _six(not_negative(damping_ratio, "damping_ratio"), "damping_ratio")

    def _gains(self) -> dict[str, Array]:
        return {"frequency": self._omega, "ratio": self._zeta}

    @gated("_body.world.call_lock")
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
        return self._answer(position, orientation, velocity, acceleration).torques.copy()


class ImpedanceControl(TaskSpaceControl):
    """Impedance control (Hogan 1985): a point on a link reacts to forces like a damped mass on a spring.

    With an external force F the error obeys Λ ë + D ė + K e = -F, where Λ is the inertia that the robot has
    there, so no measurement of forces is needed.
    """

    _spring: ClassVar[bool] = True

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
        self._zeta = not_negative(float(damping_ratio), "damping_ratio")

    def _gains(self) -> dict[str, Array]:
        return {"stiffness": self._stiffness, "ratio": self._zeta}

    @gated("_body.world.call_lock")
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
        return self._answer(position, orientation, velocity, acceleration, force).torques.copy()


def _six(value: ArrayLike, name: str) -> Array:
    """A number or six of them as six."""
    return np.broadcast_to(finite(value, name), (6,)).copy()
