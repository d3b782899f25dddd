"""Rows of joints, linearised: motors, limits, friction, actuators."""

from __future__ import annotations

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
from carom.linearization.rows import HOLDS, LOWER, NEAR, SATURATED, UPPER, Rows, status_of
from carom.linearization.turns import euler_rates, inverse, matrix_of, multiplied

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace

# Impulses of motors and actuators are known; those of limits and friction are what is left.
_ORDER = (
    (ConstraintKind.MOTOR, ConstraintKind.SPHERICAL_MOTOR, ConstraintKind.ACTUATOR),
    (ConstraintKind.LIMIT, ConstraintKind.SPHERICAL_LIMIT),
    (ConstraintKind.FRICTION,),
)
_ROUNDS = {int(kind): number for number, kinds in enumerate(_ORDER) for kind in kinds}


class JointRows:
    """Adds the rows of the joints of a world in a step to `rows`."""

    def __init__(self, space: TangentSpace, taken: TakenStep, rows: Rows, total: np.ndarray) -> None:
        """Prepare; `total` (n,) is the impulse of all rows on joints."""
        self._taken = taken
        self._rows = rows
        self._left: list[float] = total.tolist()
        self._motors: list[list[float]] = taken.motor.tolist()
        self._motor_impulses: list[float] = taken.state["dof_motor_impulse"][space.dofs].tolist()
        self._positions: list[float] = taken.joint_position.tolist()
        self._rates: list[float] = taken.free_velocity.tolist()
        self._scale = max(max(map(abs, self._left), default=0.0), 1e-300)
        self._space = space

    def add_all(self, constraints: int) -> None:
        """Add those of the first `constraints` joint constraints of the model."""
        model = self._taken.model
        kinds: list[int] = model["constraint_kind"][:constraints].tolist()
        first: list[int] = model["link_first_dof"][model["constraint_link"][:constraints]].tolist()
        self._lower: list[float] = model["constraint_lower"][:constraints].tolist()
        self._upper: list[float] = model["constraint_upper"][:constraints].tolist()
        rounds: list[list[int]] = [[] for _ in _ORDER]
        for constraint, kind in enumerate(kinds):
            if kind in _ROUNDS:
                rounds[_ROUNDS[kind]].append(constraint)
        dof_of = self._space.dof_of_row
        for chosen in rounds:
            for constraint in chosen:
                row = first[constraint]
                self._add(kinds[constraint], constraint, row, dof_of[row])

    def _add(self, kind: int, constraint: int, row: int, dof: int) -> None:
        if kind == ConstraintKind.MOTOR:
            self._add_motor(row, dof)
        elif kind == ConstraintKind.SPHERICAL_MOTOR:
            self._add_spherical_motor(row, dof)
        elif kind == ConstraintKind.ACTUATOR:
            self._add_actuator(constraint, dof)
        elif kind == ConstraintKind.LIMIT:
            self._add_limit(constraint, dof)
        elif kind == ConstraintKind.FRICTION:
            model = self._taken.model
            for own in range(dof, dof + int(model["link_dof_count"][model["constraint_link"][constraint]])):
                self._add_friction(constraint, own)
        elif max(map(abs, self._left[dof : dof + 3])) > NEAR * self._scale:
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
        impulse = self._motor_impulses[dof]
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
        error, rate = motor[MOTOR_POSITION] - self._positions[dof], self._rates[dof]
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
            (1.0, self._lower[constraint] - position),
            (-1.0, position - self._upper[constraint]),
        )
        for side, violation in sides:
            impulse = self._left[dof]
            if violation < 0.0 or side * impulse <= NEAR * self._scale:
                continue
            self._left[dof] = 0.0
            name = self._name("limit", dof)
            self._check_rigid(name, constraint)
            bound = float(taken.model["constraint_max_impulse"][constraint])
            if side * impulse >= bound * (1.0 - NEAR):
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
        bound = self._upper[constraint] * h
        if bound == 0.0:
            return
        impulse = self._left[dof]
        self._left[dof] = 0.0
        # The rest of a sum is less precise than an impulse of its own.
        status = status_of(impulse, -bound * (1.0 - NEAR), bound * (1.0 - NEAR))
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
        impulse = h * gear * force
        self._left[dof] -= impulse
        lower = float(model["actuator_force_lower"][actuator])
        upper = float(model["actuator_force_upper"][actuator])
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
            rows.by_activation[index, self._space.column_of_actuator[actuator]] = by_drive
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
