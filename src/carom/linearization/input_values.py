"""Values of controls and parameters in the worlds of an engine: reading and writing many at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.linearization.inputs import INERTIAL, OFFSETS, PARAMETERS, Input

if TYPE_CHECKING:
    from carom.engine.engine import Engine
    from carom.linearization.tangent import TangentSpace

# Parameters without effect in trees where all such terms are 0, unless "tree_joint_terms" says otherwise.
JOINT_TERMS = ("dof_armature", "dof_stiffness", "dof_implicit_damping")
_SIGNED = (OFFSETS, "actuator_gains", "actuator_biases", "motor_position_gains", "motor_velocity_gains")
_NOT_NEGATIVE = {kind for kind in PARAMETERS if kind not in _SIGNED}


class InputValues:
    """Where the values of some inputs are stored.

    Args:
        space: The tangent space of the world.
        inputs: Controls or parameters.

    Raises:
        NotImplementedError: One is no number of its own that is stored: inertial parameters, offsets.
    """

    def __init__(self, space: TangentSpace, inputs: Sequence[Input]) -> None:
        for given in inputs:
            if given.kind == INERTIAL:
                raise NotImplementedError(
                    f"{given.name!r} is no number that a world stores: choose masses and inertias instead"
                )
            if given.kind == OFFSETS:
                raise NotImplementedError(f"{given.name!r} is geometry, which cannot be changed")
        self._names = [given.name for given in inputs]
        self._bounded = np.array([given.kind in _NOT_NEGATIVE for given in inputs], dtype=bool)
        self._scales = np.array([given.scale for given in inputs])
        # Columns of values and indices, without that of the world, by table and field.
        self._groups: dict[tuple[str, str], tuple[np.ndarray, tuple[np.ndarray, ...]]] = {}
        # Columns and further places of values that several rows hold, likewise.
        self._copies = [
            ((given.table, given.field), column, place)
            for column, given in enumerate(inputs)
            for place in given.places()[1:]
        ]
        self._trees = [int(space.trees[it.row]) if it.field in JOINT_TERMS else -1 for it in inputs]
        fields: dict[tuple[str, str], list[int]] = {}
        for column, given in enumerate(inputs):
            fields.setdefault((given.table, given.field), []).append(column)
        for key, columns in fields.items():
            places = np.array([inputs[column].place for column in columns], dtype=np.int64)
            self._groups[key] = np.array(columns), tuple(places.T)

    def __len__(self) -> int:
        return len(self._names)

    def read(self, engine: Engine, worlds: np.ndarray) -> np.ndarray:
        """The values in some worlds, (m, inputs)."""
        found = np.empty((len(worlds), len(self)))
        for (table, field), (columns, places) in self._groups.items():
            array = (
                engine.arrays.state.numpy[field] if table == "state" else engine.table_of(table).numpy[field]
            )
            rows = worlds[:, None] if len(array) > 1 else np.zeros((len(worlds), 1), dtype=np.int64)
            found[:, columns] = array[(rows, *places)] / self._scales[columns]
        return found

    def check(self, values: np.ndarray) -> None:
        """Refuse values (m, inputs) that inputs cannot have.

        Raises:
            ValueError: A value is not finite, or negative where it must not be.
        """
        for wrong, must in (
            (~np.isfinite(values), "finite"),
            ((values < 0.0) & self._bounded, "at least 0"),
        ):
            if wrong.any():
                row, column = np.argwhere(wrong)[0]
                raise ValueError(f"{self._names[column]!r} must be {must}, not {values[row, column]}")

    def write(self, engine: Engine, worlds: np.ndarray, values: np.ndarray) -> None:
        """Give some worlds values (m, inputs), which `check` has passed."""
        for (table, field), (columns, places) in self._groups.items():
            scaled = values[:, columns] * self._scales[columns]
            if table == "state":
                engine.arrays.state.numpy[field][(worlds[:, None], *places)] = scaled
                continue
            engine.spread(table, field)
            fields = engine.table_of(table)
            fields.numpy[field][(worlds[:, None], *places)] = scaled
            for key, column, place in self._copies:
                if key == (table, field):
                    fields.numpy[field][(worlds, *place)] = values[:, column] * self._scales[column]
            fields.written(field)
            if field in JOINT_TERMS:
                for column in columns.tolist():
                    used = worlds[values[:, column] != 0.0]
                    if len(used):
                        ones, tree = np.ones(len(used)), self._trees[column]
                        engine.set_parameter("model", "tree_joint_terms", tree, ones, used)
