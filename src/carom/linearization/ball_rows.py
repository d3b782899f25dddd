"""Rows of the motors of spherical joints, linearised; those of other joints are added by a kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import (
    MOTOR_DAMPING,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_TARGET_W,
    ConstraintKind,
)
from carom.linearization.rows import HOLDS, LOWER, Rows, status_of
from carom.linearization.turns import euler_rates, inverse, matrix_of, multiplied

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace


def ball_motors(model: dict[str, np.ndarray], constraints: int) -> list[int]:
    """The joint constraints that are motors of spherical joints, of the first `constraints` of a model."""
    kinds = model["constraint_kind"][:constraints]
    return np.flatnonzero(kinds == ConstraintKind.SPHERICAL_MOTOR).tolist()


def add_ball_motor(space: TangentSpace, taken: TakenStep, rows: Rows, constraint: int) -> None:
    """Add the three rows of the motor of a spherical joint, a joint constraint."""
    row = int(taken.model["link_first_dof"][taken.model["constraint_link"][constraint]])
    dof = space.dof_of_row[row]
    motor = taken.motor[dof : dof + 3]
    if not motor[:, MOTOR_MAX_IMPULSE].any():
        return
    target = np.array([*motor[:, MOTOR_POSITION], motor[0, MOTOR_TARGET_W]])
    turned = multiplied(inverse(target), space.ball_position(dof, taken.position))
    name = f"motor of {space.labels[dof][0]}"
    rates: np.ndarray | None = None
    for axis in range(3):
        bound = float(motor[axis, MOTOR_MAX_IMPULSE])
        impulse = float(taken.state["dof_motor_impulse"][row + axis])
        status = status_of(impulse, -bound, bound)
        if status != HOLDS:
            index = rows.add_of_dof(name, status, dof + axis, impulse, 0.0, 1.0)
            sign = -1.0 if status == LOWER else 1.0
            rows.set_input(index, "dof_motor", (row + axis, MOTOR_MAX_IMPULSE), sign)
            continue
        if rates is None:
            rates = euler_rates(matrix_of(turned / np.sqrt(turned @ turned)))
        index = rows.add_of_dof(name, HOLDS, dof + axis, impulse, 1.0, 0.0)
        gain = motor[axis, MOTOR_KP] * taken.parameters.erp / taken.time_step
        rows.by_position[index][dof : dof + 3] = -gain * rates[axis]
        rows.by_free_velocity[index][dof + axis] = 1.0 - motor[axis, MOTOR_DAMPING]
