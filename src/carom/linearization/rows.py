"""Rows of the solver, linearised; here those of joints: motors, limits, friction, actuators.

Together they are α d(J v⁺) + β dλ = the right side, with matrices α and β over the rows. A row that holds
within its bounds has an entry of α on the diagonal, one at a bound of its impulse only entries of β.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_TARGET_W,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
    UNFILTERED,
    ConstraintKind,
)
from carom.linearization.turns import euler_rates, inverse, matrix_of, multiplied

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace

HOLDS, LOWER, UPPER, SATURATED = (
    "holds",
    "at its lower bound",
    "at its upper bound",
    "at its greatest velocity",
)
# Impulses this near to a bound, relative to it, are at it: clamping rounds.
_NEAR = 1e-9


class Rows:
    """Linearised rows, in the order they are added.

    Attributes:
        names: Name and status of each, such as ("motor of arm.elbow", "holds").
    """

    def __init__(self, space: TangentSpace, inputs: Sequence[Input]) -> None:
        self._space = space
        self._width = len(space), len(space.activations), len(inputs)
        self.all_inputs: Sequence[Input] = inputs
        # Inputs by where they are stored.
        self.inputs: dict[tuple[str, tuple[int, ...]], list[int]] = {}
        for column, given in enumerate(inputs):
            self.inputs.setdefault((given.field, given.place), []).append(column)
        self._scales = [given.scale for given in inputs]
        self.names: list[tuple[str, str]] = []
        self.jacobian: list[np.ndarray] = []
        self.impulses: list[float] = []
        # Entries of the matrices α and β, (row, column, value).
        self.alpha: list[tuple[int, int, float]] = []
        self.beta: list[tuple[int, int, float]] = []
        self.hessians: dict[int, np.ndarray] = {}
        self.by_position: list[np.ndarray] = []
        self.by_free_velocity: list[np.ndarray] = []
        self.by_activation: list[np.ndarray] = []
        self.by_input: list[np.ndarray] = []

    def __len__(self) -> int:
        return len(self.names)

    def add(
        self, name: str, status: str, jacobian: np.ndarray, impulse: float, alpha: float, beta: float
    ) -> int:
        """Add a row without right side; returns its number."""
        dofs, active, inputs = self._width
        self.names.append((name, status))
        self.jacobian.append(jacobian)
        self.impulses.append(impulse)
        row = len(self.names) - 1
        self.alpha.append((row, row, alpha))
        self.beta.append((row, row, beta))
        side = np.zeros(2 * dofs + active + inputs)
        self.by_position.append(side[:dofs])
        self.by_free_velocity.append(side[dofs : 2 * dofs])
        self.by_activation.append(side[2 * dofs : 2 * dofs + active])
        self.by_input.append(side[2 * dofs + active :])
        return row

    def set_hessian(self, row: int, hessian: np.ndarray) -> None:
        """Set the derivatives of a row's Jacobian by positions: of entry i by dof j, (n, n)."""
        self.hessians[row] = hessian

    def matrix(self, entries: list[tuple[int, int, float]]) -> np.ndarray:
        """`alpha` or `beta` as a matrix."""
        found = np.zeros((len(self), len(self)))
        for row, column, value in entries:
            found[row, column] += value
        return found

    def generalized_impulses(self) -> np.ndarray:
        """Jᵀ λ of all rows, (n,)."""
        found = np.zeros(self._width[0])
        for jacobian, impulse in zip(self.jacobian, self.impulses, strict=True):
            found += impulse * jacobian
        return found

    def add_of_dof(self, name: str, status: str, dof: int, impulse: float, alpha: float, beta: float) -> int:
        """As `add`, for a row on one dof."""
        jacobian = np.zeros(self._width[0])
        jacobian[dof] = 1.0
        return self.add(name, status, jacobian, impulse, alpha, beta)

    def set_input(self, row: int, field: str, place: tuple[int, ...], derivative: float) -> None:
        """Set the derivative of a row's right side by the number stored at a place."""
        for column in self.inputs.get((field, place), ()):
            self.by_input[row][column] += derivative * self._scales[column]


def status_of(impulse: float, lower: float, upper: float) -> str:
    """Whether a row holds, or at which bound its impulse is."""
    if impulse <= lower + _NEAR * abs(lower):
        return LOWER
    return UPPER if impulse >= upper - _NEAR * abs(upper) else HOLDS


class JointRows:
    """Adds the rows of the joints of a world in a step to `rows`."""

    def __init__(self, space: TangentSpace, taken: TakenStep, rows: Rows, total: np.ndarray) -> None:
        """Prepare; `total` (n,) is the impulse of all rows on joints."""
        self._taken = taken
        self._rows = rows
        self._left = total.copy()
        self._motors: list[list[float]] = taken.motor.tolist()
        self._positions: list[float] = taken.joint_position.tolist()
        self._scale = max(float(np.abs(total).max(initial=0.0)), 1e-300)
        self._of_row = {int(row): dof for dof, row in enumerate(space.dofs)}
        self._space = space
        self._activation = {int(row): column for column, row in enumerate(space.activations)}

    def add_all(self, constraints: int) -> None:
        """Add those of the first `constraints` joint constraints of the model."""
        model = self._taken.model
        kinds = model["constraint_kind"][:constraints].tolist()
        links = model["constraint_link"][:constraints].tolist()
        # Impulses of motors and actuators are known; those of limits and friction are what is left.
        for order in (
            (ConstraintKind.MOTOR, ConstraintKind.SPHERICAL_MOTOR, ConstraintKind.ACTUATOR),
            (ConstraintKind.LIMIT, ConstraintKind.SPHERICAL_LIMIT),
            (ConstraintKind.FRICTION,),
        ):
            for constraint in range(constraints):
                kind = kinds[constraint]
                if kind in order:
                    row = int(model["link_first_dof"][links[constraint]])
                    self._add(ConstraintKind(kind), constraint, row)

    def _add(self, kind: ConstraintKind, constraint: int, row: int) -> None:
        dof = self._of_row[row]
        if kind == ConstraintKind.MOTOR:
            self._add_motor(row, dof)
        elif kind == ConstraintKind.SPHERICAL_MOTOR:
            self._add_spherical_motor(row, dof)
        elif kind == ConstraintKind.ACTUATOR:
            self._add_actuator(constraint, dof)
        elif kind == ConstraintKind.LIMIT:
            self._add_limit(constraint, dof)
        elif kind == ConstraintKind.FRICTION:
            count = int(self._taken.model["link_dof_count"][self._taken.model["constraint_link"][constraint]])
            for own in range(dof, dof + count):
                self._add_friction(constraint, own)
        elif np.abs(self._left[dof : dof + 3]).max() > _NEAR * self._scale:
            raise NotImplementedError(
                self._name("limit", dof) + ", a spherical joint, has no exact derivatives"
            )

    def _check_rigid(self, name: str, constraint: int) -> None:
        """Raise `NotImplementedError` if a limit or friction that holds yields, as those of MJCF files do."""
        if self._taken.model["constraint_impedance"][constraint][1] > 0.0:
            raise NotImplementedError(f"{name} yields, so that it has no exact derivatives")

    def _name(self, what: str, dof: int) -> str:
        return f"{what} of {self._space.labels[dof][0]}"

    def _motor_bound(self, row: int, dof: int) -> tuple[int | None, float, str]:
        """The row of a motor at a bound of its impulse; else None. Also its impulse and its name."""
        bound = self._motors[dof][MOTOR_MAX_IMPULSE]
        impulse = float(self._taken.state["dof_motor_impulse"][row])
        self._left[dof] -= impulse
        status, name = status_of(impulse, -bound, bound), self._name("motor", dof)
        if status == HOLDS:
            return None, impulse, name
        index = self._rows.add_of_dof(name, status, dof, impulse, 0.0, 1.0)
        sign = -1.0 if status == LOWER else 1.0
        self._rows.set_input(index, "dof_motor", (row, MOTOR_MAX_IMPULSE), sign)
        return index, impulse, name

    def _add_motor(self, row: int, dof: int) -> None:
        taken, rows = self._taken, self._rows
        motor = self._motors[dof]
        if motor[MOTOR_MAX_IMPULSE] == 0.0:
            return
        index, impulse, name = self._motor_bound(row, dof)
        if index is not None:
            return
        h = taken.time_step
        error, rate = motor[MOTOR_POSITION] - self._positions[dof], float(taken.free_velocity[dof])
        wanted = motor[MOTOR_KP] * error / h + rate + motor[MOTOR_KD] * (motor[MOTOR_VELOCITY] - rate)
        if abs(wanted) > motor[MOTOR_VELOCITY_CLAMP]:
            rows.add_of_dof(name, SATURATED, dof, impulse, 1.0, 0.0)
            return
        index = rows.add_of_dof(name, HOLDS, dof, impulse, 1.0, 0.0)
        rows.by_position[index][dof] = -motor[MOTOR_KP] / h
        rows.by_free_velocity[index][dof] = 1.0 - motor[MOTOR_KD]
        rows.set_input(index, "dof_motor", (row, MOTOR_POSITION), motor[MOTOR_KP] / h)
        rows.set_input(index, "dof_motor", (row, MOTOR_VELOCITY), motor[MOTOR_KD])
        rows.set_input(index, "dof_motor", (row, MOTOR_KP), error / h)
        rows.set_input(index, "dof_motor", (row, MOTOR_KD), motor[MOTOR_VELOCITY] - rate)

    def _add_spherical_motor(self, row: int, dof: int) -> None:
        taken, rows = self._taken, self._rows
        motor = taken.motor[dof : dof + 3]
        if not motor[:, MOTOR_MAX_IMPULSE].any():
            return
        target = np.array([*motor[:, MOTOR_POSITION], motor[0, MOTOR_TARGET_W]])
        joint = self._space.ball_position(dof, taken.position)
        turned = multiplied(inverse(target), joint)
        rates: np.ndarray | None = None
        for axis in range(3):
            index, impulse, name = self._motor_bound(row + axis, dof + axis)
            if index is not None:
                continue
            if rates is None:
                rates = euler_rates(matrix_of(turned / np.sqrt(turned @ turned)))
            index = rows.add_of_dof(name, HOLDS, dof + axis, impulse, 1.0, 0.0)
            gain = motor[axis, MOTOR_KP] * taken.parameters.erp / taken.time_step
            rows.by_position[index][dof : dof + 3] = -gain * rates[axis]
            rows.by_free_velocity[index][dof + axis] = 1.0 - motor[axis, MOTOR_DAMPING]

    def _add_limit(self, constraint: int, dof: int) -> None:
        taken, rows = self._taken, self._rows
        position = self._positions[dof]
        sides = (
            (1.0, float(taken.model["constraint_lower"][constraint]) - position),
            (-1.0, position - float(taken.model["constraint_upper"][constraint])),
        )
        for side, violation in sides:
            impulse = float(self._left[dof])
            if violation < 0.0 or side * impulse <= _NEAR * self._scale:
                continue
            self._left[dof] = 0.0
            name = self._name("limit", dof)
            self._check_rigid(name, constraint)
            bound = float(taken.model["constraint_max_impulse"][constraint])
            if side * impulse >= bound * (1.0 - _NEAR):
                rows.add_of_dof(name, UPPER if side > 0.0 else LOWER, dof, impulse, 0.0, 1.0)
                continue
            parameters = taken.parameters
            corrected = (
                not parameters.split_impulse or -violation > parameters.split_impulse_penetration_threshold
            )
            index = rows.add_of_dof(name, HOLDS, dof, impulse, 1.0, 0.0)
            rows.by_position[index][dof] = -parameters.erp / taken.time_step if corrected else 0.0

    def _add_friction(self, constraint: int, dof: int) -> None:
        taken, rows = self._taken, self._rows
        h = taken.time_step
        bound = float(taken.model["constraint_upper"][constraint]) * h
        if bound == 0.0:
            return
        impulse = float(self._left[dof])
        self._left[dof] = 0.0
        # The rest of a sum is less precise than an impulse of its own.
        status = status_of(impulse, -bound * (1.0 - _NEAR), bound * (1.0 - _NEAR))
        name = self._name("friction", dof)
        if status == HOLDS:
            self._check_rigid(name, constraint)
            rows.add_of_dof(name, HOLDS, dof, impulse, 1.0, 0.0)
            return
        index = rows.add_of_dof(name, status, dof, impulse, 0.0, 1.0)
        rows.set_input(index, "constraint_upper", (constraint,), -h if status == LOWER else h)

    def _add_actuator(self, constraint: int, dof: int) -> None:
        taken, rows, model = self._taken, self._rows, self._taken.model
        actuator, h = int(model["constraint_actuator"][constraint]), taken.time_step
        name = self._name("actuator", dof)
        if model["actuator_is_muscle"][actuator]:
            raise NotImplementedError(f"{name} is a muscle, which has no exact derivatives")
        gear = float(model["actuator_gear"][actuator])
        force = float(taken.state["actuator_force"][actuator])
        if model["actuator_to_next"][actuator]:
            raise NotImplementedError(
                f"{name} and others of its joint have a bound of their sum; that has no exact derivatives"
            )
        bounds = sorted(
            float(model[f"actuator_joint_{side}"][actuator]) / gear for side in ("lower", "upper")
        )
        lower = max(float(model["actuator_force_lower"][actuator]), bounds[0])
        upper = min(float(model["actuator_force_upper"][actuator]), bounds[1])
        force = min(max(force, lower), upper)
        impulse = h * gear * force
        self._left[dof] -= impulse
        status = status_of(force, lower, upper)
        if status != HOLDS:
            rows.add_of_dof(name, status, dof, impulse, 0.0, 1.0)
            return
        filtered = model["actuator_dynamics"][actuator] != UNFILTERED
        control, within = bounded_control(taken, actuator)
        drive = float(taken.activation[actuator]) if filtered else control
        gain, bias = model["actuator_gain"][actuator], model["actuator_bias"][actuator]
        length = gear * taken.joint_position[dof]
        before, after = gear * taken.free_velocity[dof], gear * taken.solved[dof]
        terms = gain * drive + bias
        # Of length and velocity, those at the end count where the force falls with them.
        soft = terms[1] < 0.0, terms[2] < 0.0
        ends = np.array([1.0, length + h * after if soft[0] else length, after if soft[1] else before])
        yielding = -gear * gear * h * (h * terms[1] * soft[0] + terms[2] * soft[1])
        index = rows.add_of_dof(name, HOLDS, dof, impulse, yielding, 1.0)
        share = h * gear
        rows.by_position[index][dof] = share * gear * terms[1]
        rows.by_free_velocity[index][dof] = 0.0 if soft[1] else share * gear * terms[2]
        by_drive = share * float(gain @ ends)
        if filtered:
            rows.by_activation[index][self._activation[actuator]] = by_drive
        elif within:
            rows.set_input(index, "actuator_control", (actuator,), by_drive)
        for term in range(3):
            rows.set_input(index, "actuator_gain", (actuator, term), share * drive * ends[term])
            rows.set_input(index, "actuator_bias", (actuator, term), share * ends[term])


def bounded_control(taken: TakenStep, actuator: int) -> tuple[float, bool]:
    """The control of an actuator within its range, and whether a change has an effect."""
    lower, upper = (taken.model[f"actuator_control_{side}"][actuator] for side in ("lower", "upper"))
    control = float(taken.control[actuator])
    return min(max(control, lower), upper), bool(lower <= control <= upper)
