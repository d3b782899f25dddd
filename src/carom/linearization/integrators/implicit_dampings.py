"""The damping D of MuJoCo's implicit integrators, and how D x changes.

D has the damping of joints; with implicitfast and implicit also that of tendons and of actuators within their
ranges; see `kernels.integrators.velocity_terms`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import PATH_JOINT, UNFILTERED, ConstraintKind, UserConstraintKind
from carom.layouts.linearization import TENDON_SPRING, TRANSMISSION_ROW

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.linearization.inputs import Input
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace

_UNBOUNDED = 1e30
_GAINS = "actuator_gain", "actuator_bias"
_CURE = 'use method="differences", or integrator="discrete"'


@dataclass(frozen=True, eq=False, slots=True)
class Arm:
    """What damps along a direction of the dofs.

    Attributes:
        along: The direction, (n,).
        damping: By how much the force along it falls with the rate along it.
        actuator: The row of its actuator, or -1.
        drive: What the actuator acts by.
    """

    along: np.ndarray
    damping: float
    actuator: int = -1
    drive: float = 0.0


class Dampings:
    """What damps the dofs of a world in a step that has been performed, apart from joints themselves.

    Attributes:
        arms: All of them.
        armature: Directions along which tendons have inertia, and how much.
    """

    def __init__(
        self, space: TangentSpace, copies: Copies, memory: StepMemory, place: int, taken: TakenStep
    ) -> None:
        self._space, self._taken = space, taken
        self._memory, self._place = memory, place
        self.arms: list[Arm] = []
        self.armature: list[tuple[np.ndarray, float]] = []
        self._users: dict[str, np.ndarray] = copies.engine.contact_arrays.users.numpy
        self._varied: set[int] = set()
        self._constraints = copies.engine.arrays.used["constraint"]

    def find(self, inputs: Sequence[Input], *, with_forces: bool) -> None:
        """Find them: inertia, and, `with_forces`, damping of tendons and actuators.

        Args:
            inputs: Controls and parameters.
            with_forces: Whether it is not only inertia.

        Raises:
            NotImplementedError: One has no exact derivatives.
        """
        self._varied = {it.place[0] for it in inputs if it.field in _GAINS}
        rows = slice(int(self._memory.row_count[self._place]))
        kinds = self._memory.row_kind[self._place, rows]
        users, jacobian = self._memory.row_dof[self._place], self._memory.jacobian[self._place]
        for row in np.flatnonzero(kinds == TENDON_SPRING).tolist():
            user = int(users[row])
            armature, damping = self._users["user_armature"][user], self._users["user_spring"][user][1]
            if armature > 0.0:
                self._refuse_path(user, "armature")
                self.armature.append((jacobian[row].copy(), float(armature)))
            if with_forces and damping > 0.0:
                self._refuse_path(user, "damping")
                self.arms.append(Arm(jacobian[row].copy(), float(damping)))
        if with_forces:
            self._add_joints()
            for row in np.flatnonzero(kinds == TRANSMISSION_ROW).tolist():
                self._add_transmission(int(users[row]), jacobian[row].copy())

    def _refuse_path(self, user: int, what: str) -> None:
        users = self._users
        path = slice(users["user_first_path"][user], users["user_second_path"][user])
        is_transmission = users["user_kind"][user] == UserConstraintKind.TRANSMISSION
        is_wrench = is_transmission and users["user_is_wrench"][user]
        if is_wrench or (users["path_kind"][path] != PATH_JOINT).any():
            raise NotImplementedError(
                f"{what} along a path or at a site (user constraint {user}) has no exact derivatives with "
                f"integrator={self._taken.parameters.integrator!r}: {_CURE}"
            )

    def _add_joints(self) -> None:
        model, space = self._taken.model, self._space
        kinds = model["constraint_kind"][: self._constraints]
        for constraint in np.flatnonzero(kinds == ConstraintKind.ACTUATOR).tolist():
            actuator = int(model["constraint_actuator"][constraint])
            dof = space.dof_of_row[int(model["link_first_dof"][model["constraint_link"][constraint]])]
            if not self._damps(actuator):
                continue
            along = np.zeros(len(space))
            along[dof] = model["actuator_gear"][actuator]
            link = model["constraint_link"][constraint]
            length = along[dof] * self._taken.position[model["link_first_position"][link]]
            drive = self._drive(actuator)
            ends = np.array([1.0, length, along @ self._taken.velocity])
            force = (model["actuator_gain"][actuator] * drive + model["actuator_bias"][actuator]) @ ends
            lower, upper = model["actuator_force_lower"][actuator], model["actuator_force_upper"][actuator]
            if lower <= force <= upper and not self._is_at_bound(actuator):
                self._add(actuator, along, drive)

    def _is_at_bound(self, actuator: int) -> bool:
        """Whether the sum of the forces of all actuators of a joint is at a bound, or beyond it."""
        model, forces = self._taken.model, self._taken.state["actuator_force"]
        lower, upper = model["actuator_joint_lower"][actuator], model["actuator_joint_upper"][actuator]
        if min(-lower, upper) >= _UNBOUNDED:
            return False
        total, other = 0.0, actuator - int(model["actuator_follows"][actuator])
        while True:
            total += float(model["actuator_gear"][other] * forces[other])
            step = int(model["actuator_to_next"][other])
            if step == 0:
                return bool(total <= lower or total >= upper)
            other += step

    def _add_transmission(self, user: int, along: np.ndarray) -> None:
        actuator = int(self._users["user_actuator"][user])
        if not self._damps(actuator):
            return
        self._refuse_path(user, "damping of an actuator")
        model = self._taken.model
        bounds = model["actuator_joint_lower"][actuator], model["actuator_joint_upper"][actuator]
        if max(map(abs, bounds)) < _UNBOUNDED:
            raise NotImplementedError(
                "damping of actuators of a tendon whose sum has bounds has no exact derivatives with "
                f"integrator={self._taken.parameters.integrator!r}: {_CURE}"
            )
        force = self._taken.state["actuator_force"][actuator]
        lower, upper = model["actuator_force_lower"][actuator], model["actuator_force_upper"][actuator]
        if lower < force < upper:
            self._add(actuator, along, self._drive(actuator))

    def _add(self, actuator: int, along: np.ndarray, drive: float) -> None:
        model = self._taken.model
        damping = -(model["actuator_gain"][actuator][2] * drive + model["actuator_bias"][actuator][2])
        self.arms.append(Arm(along, float(damping), actuator, drive))

    def _damps(self, actuator: int) -> bool:
        """Whether the force of an actuator depends on its velocity, or may."""
        model = self._taken.model
        if model["actuator_is_muscle"][actuator]:
            raise NotImplementedError(
                "muscles have no exact derivatives with "
                f"integrator={self._taken.parameters.integrator!r}: {_CURE}"
            )
        terms = model["actuator_gain"][actuator][2], model["actuator_bias"][actuator][2]
        return any(terms) or actuator in self._varied

    def _drive(self, actuator: int) -> float:
        """What an actuator acts by."""
        model, state = self._taken.model, self._taken.state
        if model["actuator_dynamics"][actuator] == UNFILTERED:
            lower, upper = (
                model["actuator_control_lower"][actuator],
                model["actuator_control_upper"][actuator],
            )
            return float(min(max(state["actuator_control"][actuator], lower), upper))
        if model["actuator_is_early"][actuator]:
            return float(state["actuator_activation"][actuator])
        return float(self._taken.activation[actuator])

    def add_changes(self, found: np.ndarray, x: np.ndarray, inputs: Sequence[Input]) -> None:
        """Add how D x changes with states and inputs at a constant x (n,) to (n, columns)."""
        width = self._memory.step.shape[1]
        for arm in self.arms:
            if arm.actuator < 0:
                continue
            model, actuator = self._taken.model, arm.actuator
            gain = model["actuator_gain"][actuator][2]
            by = np.zeros(found.shape[1])
            if gain:
                by -= gain * self._drive_changes(actuator, inputs)
            for column, given in enumerate(inputs, width):
                if given.place == (actuator, 2) and given.field in _GAINS:
                    by[column] -= given.scale * (arm.drive if given.field == "actuator_gain" else 1.0)
            found += np.outer(arm.along * (arm.along @ x), by)

    def _drive_changes(self, actuator: int, inputs: Sequence[Input]) -> np.ndarray:
        """How what an actuator acts by changes with states and inputs, (columns,)."""
        model, width = self._taken.model, self._memory.step.shape[1]
        by = np.zeros(self._memory.step.shape[2])
        column = 2 * len(self._space) + self._space.column_of_actuator.get(actuator, 0)
        if model["actuator_dynamics"][actuator] == UNFILTERED:
            lower, upper = (
                model["actuator_control_lower"][actuator],
                model["actuator_control_upper"][actuator],
            )
            if lower <= self._taken.control[actuator] <= upper:
                for place, given in enumerate(inputs, width):
                    if given.field == "actuator_control" and given.place == (actuator,):
                        by[place] = given.scale
        elif model["actuator_is_early"][actuator]:
            by[:] = self._memory.step[self._place, column]
        else:
            by[column] = 1.0
        return by
