"""A state and values of controls at which a world is linearised, in place of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import vector

if TYPE_CHECKING:
    from carom.linearization.inputs import Input
    from carom.linearization.tangent import TangentSpace


@dataclass(frozen=True, eq=False, slots=True)
class Start:
    """Where users want a world to be linearised; None leaves a part as it is.

    Attributes:
        positions: As `World.position`.
        velocities: As `World.velocity`.
        activations: Activations in the order of `LinearizedStep.states`, (a,).
        controls: Values of the controls chosen, (nu,).
    """

    positions: ArrayLike | None = None
    velocities: ArrayLike | None = None
    activations: ArrayLike | None = None
    controls: ArrayLike | None = None

    def checked(self, space: TangentSpace, controls: Sequence[Input]) -> GivenState:
        """The same as arrays.

        Raises:
            ValueError: A length is wrong, or a number is not finite.
        """
        parts: dict[str, np.ndarray] = {}
        for field, value, count, name in (
            ("position", self.positions, space.coordinates, "positions"),
            ("dof_velocity", self.velocities, space.rates, "velocities"),
        ):
            if value is not None:
                given = np.asarray(value, dtype=float)
                # `World.position` and `World.velocity` may have spare rows.
                known = count[0] if given.shape != (count[1],) else count[1]
                parts[field] = vector(given, known, name)[: count[0]]
        active, values = self.activations, self.controls
        return GivenState(
            parts,
            space.activations,
            None if active is None else vector(active, len(space.activations), "activations"),
            controls,
            None if values is None else vector(values, len(controls), "control_values"),
        )


@dataclass(frozen=True, eq=False, slots=True)
class GivenState:
    """What replaces parts of the state of a world.

    Attributes:
        parts: First rows of fields of the state.
        actuators: Rows of actuators with activations.
        activations: Their activations, or None.
        controls: The controls that are chosen.
        values: Their values, or None.
    """

    parts: dict[str, np.ndarray]
    actuators: np.ndarray
    activations: np.ndarray | None
    controls: Sequence[Input]
    values: np.ndarray | None

    def write(self, fields: dict[str, np.ndarray]) -> None:
        """Write them to the state of all worlds of a table."""
        for name, numbers in self.parts.items():
            fields[name][:, : len(numbers)] = numbers
        if self.activations is not None:
            fields["actuator_activation"][:, self.actuators] = self.activations
        if self.values is not None:
            for given, value in zip(self.controls, self.values.tolist(), strict=True):
                fields[given.field][(slice(None), *given.place)] = given.scale * value
