"""Memory of the kernels that linearise a step: structs over it, and it as matrices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.codes import (
    BASE_VELOCITIES,
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
)
from carom.layouts.linearization import (
    BALL_DOF,
    BASE_DOF,
    INPUT_BIAS,
    INPUT_BOUND,
    INPUT_CONTROL,
    INPUT_FRICTION,
    INPUT_GAIN,
    PLANE_DOF,
    SCALAR_DOF,
    StepBatch,
    StepSpace,
)
from carom.native.tables import put_array, put_zeros

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace

_OF_MOTORS = (MOTOR_POSITION, MOTOR_VELOCITY, MOTOR_KP, MOTOR_KD, MOTOR_MAX_IMPULSE)
# Numbers in the arrays of all worlds that are linearised together, at most.
_MAX_NUMBERS = 1 << 23


def step_space(space: TangentSpace, inputs: Sequence[Input], counts: dict[str, int]) -> Any:
    """The struct of a tangent space and of inputs.

    Args:
        space: The tangent space.
        inputs: The inputs.
        counts: Number of joint constraints, of actuators, and of links.
    """
    made: Any = StepSpace()
    made.dofs, made.states = len(space), 2 * len(space) + len(space.activations)
    made.columns = made.states + len(inputs)
    made.constraints, made.actuators = counts["constraint"], counts["actuator"]
    positions, firsts, hands = space.firsts()
    of_row = np.full(space.rates[1], -1)
    of_row[space.dofs] = np.arange(len(space))
    column = np.full(counts["actuator"], -1)
    column[space.activations] = np.arange(len(space.activations))
    for name, values in (
        *(("dof_row", space.dofs), ("dof_position", positions), ("dof_first", firsts)),
        *(("dof_hand", hands), ("dof_tree", space.trees), ("dof_place", space.places_in_tree)),
        *(("row_dof", of_row), ("actuator_column", column), ("dof_group", _groups(firsts))),
    ):
        put_array(made, name, values)
    _put_inputs(made, space, inputs, counts)
    return made


def _groups(kinds: np.ndarray) -> np.ndarray:
    """The first dof of the joint or base of each dof, of what each is the first of."""
    groups = np.arange(len(kinds))
    sizes = {BASE_DOF: BASE_VELOCITIES, BALL_DOF: 3, PLANE_DOF: 3}
    for dof in np.flatnonzero(kinds != SCALAR_DOF).tolist():
        groups[dof : dof + sizes[int(kinds[dof])]] = dof
    return groups


def _put_inputs(made: Any, space: TangentSpace, inputs: Sequence[Input], counts: dict[str, int]) -> None:
    """Put the inputs of rows in lists, one for each dof, constraint, actuator and link."""
    sizes = {"dof": len(space), **counts}
    first = {axis: np.full(sizes[axis], -1) for axis in ("dof", "constraint", "actuator", "link")}
    following, numbers = np.full(len(inputs), -1), np.full(len(inputs), -1)
    for column, given in enumerate(inputs):
        if given.field == "dof_motor" and given.place[1] in _OF_MOTORS:
            axis, row, number = "dof", space.dof_of_row[given.place[0]], given.place[1]
        elif given.field == "constraint_upper":
            axis, row, number = "constraint", given.place[0], INPUT_BOUND
        elif given.field == "actuator_control":
            axis, row, number = "actuator", given.place[0], INPUT_CONTROL
        elif given.field == "shape_lateral_friction":
            axis, row, number = "link", given.row, INPUT_FRICTION
        elif given.field in ("actuator_gain", "actuator_bias"):
            base = INPUT_GAIN if given.field == "actuator_gain" else INPUT_BIAS
            axis, row, number = "actuator", given.place[0], base + given.place[1]
        else:
            continue
        numbers[column] = number
        following[column], first[axis][row] = first[axis][row], column
    for axis, rows in first.items():
        put_array(made, f"{axis}_input", rows)
    put_array(made, "input_next", following)
    put_array(made, "input_number", numbers)
    put_array(made, "input_scale", [given.scale for given in inputs])


class StepMemory:
    """The arrays of some worlds, each with a place of its own.

    Attributes:
        batch: The struct.
        places: Number of places.
        rows: Number of rows that each has room for.
        world, problem, problem_of, row_count: See `StepBatch`, (places,).
        row_kind, row_status, row_dof: (places, rows).
        velocity: (places, 3, n).
        effective, inverse: (places, n, n).
        force: (places, 2, n, columns).
        row_impulse, row_asked, row_mass, row_switch, row_yield: (places, rows).
        jacobian, through: (places, rows, n).
        side: (places, rows, columns).
        alpha, beta: (places, rows, rows).
        step: (places, states, columns).
        measured, near: (places, contacts).
        measured_motion: (motions, n, 3, 3): of each dof how both points and the normal move.
    """

    def __init__(self, space: Any, places: int) -> None:
        """Make the arrays for the sizes of a `StepSpace`."""
        n, rows, columns, states = space.dofs, space.most_rows, space.columns, space.states
        self.batch: Any = StepBatch()
        self.places, self.rows = places, rows
        for name in ("impulse", "response", "rate", "system", "solution", "wanted", "change"):
            put_zeros(self.batch, name, places * _sizes(space)[name])
        for name in ("axis_angular", "axis_linear", "reach", "reach_side", "moved_a", "moved_b"):
            put_zeros(self.batch, name, places * n)
        put_zeros(self.batch, "turned", 3 * places * n)
        put_zeros(self.batch, "bent", 6 * places * n)
        self._dofs = n
        self.measured: np.ndarray = self._made("measured", space.most_contacts)
        self.near: np.ndarray = self._made("near", space.most_contacts)
        self.measured_motion: np.ndarray = put_zeros(self.batch, "measured_motion", 0).reshape(0, n, 3, 3)
        self.world: np.ndarray = self._made("world")
        self.problem: np.ndarray = self._made("problem")
        self.problem_of: np.ndarray = self._made("problem_of")
        self.row_count: np.ndarray = self._made("row_count")
        self.row_kind: np.ndarray = self._made("row_kind", rows)
        self.row_status: np.ndarray = self._made("row_status", rows)
        self.row_dof: np.ndarray = self._made("row_dof", rows)
        self.velocity: np.ndarray = self._made("velocity", 3, n)
        self.effective: np.ndarray = self._made("effective", n, n)
        self.inverse: np.ndarray = self._made("inverse", n, n)
        self.force: np.ndarray = self._made("force", 2, n, columns)
        self.row_impulse: np.ndarray = self._made("row_impulse", rows)
        self.row_asked: np.ndarray = self._made("row_asked", rows)
        self.row_mass: np.ndarray = self._made("row_mass", rows)
        self.row_switch: np.ndarray = self._made("row_switch", rows)
        self.row_yield: np.ndarray = self._made("row_yield", rows)
        self.jacobian: np.ndarray = self._made("jacobian", rows, n)
        self.through: np.ndarray = self._made("through", rows, n)
        self.side: np.ndarray = self._made("side", rows, columns)
        self.alpha: np.ndarray = self._made("alpha", rows, rows)
        self.beta: np.ndarray = self._made("beta", rows, rows)
        self.step: np.ndarray = self._made("step", states, columns)
        self._square = places, rows * rows

    def _made(self, name: str, *shape: int) -> np.ndarray:
        count = self.places * int(np.prod(shape, dtype=np.int64))
        return put_zeros(self.batch, name, count).reshape(self.places, *shape)

    def make_motions(self, count: int) -> bool:
        """Make room for the measured motions of at least so many contacts; whether that is other memory."""
        if len(self.measured_motion) >= count:
            return False
        more = put_zeros(self.batch, "measured_motion", 6 * count * self._dofs)
        self.measured_motion = more.reshape(2 * count, self._dofs, 3, 3)
        return True

    def square(self, name: str, place: int, rows: int) -> np.ndarray:
        """`system` or `solution` of a place, (rows, rows)."""
        found: np.ndarray = self.batch.memory[name]
        return found.reshape(self._square)[place, : rows * rows].reshape(rows, rows)


def _sizes(space: Any) -> dict[str, int]:
    n, rows, columns = space.dofs, space.most_rows, space.columns
    return {
        **{"impulse": n, "response": n * rows, "rate": n * rows, "wanted": rows * columns},
        **{"system": rows * rows, "solution": rows * rows, "change": 2 * n * columns},
    }


def places_for(space: Any, worlds: int) -> int:
    """How many of some worlds to linearise together."""
    n, rows, columns = space.dofs, space.most_rows, space.columns
    each = (
        16 * n * n + 34 * n + (5 * n + space.states) * columns + rows * (4 * rows + 4 * n + 2 * columns + 8)
    )
    return max(1, min(worlds, _MAX_NUMBERS // max(each, 1)))
