"""What is at a switch of a step without having a row: muscles, and contacts that do not push yet."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import MUSCLE
from carom.linearization.row_names import contact_name

if TYPE_CHECKING:
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.stepping import Copies
    from carom.linearization.tangent import TangentSpace

# An activation that is nearer than this to its control rises and falls with other time constants.
_SAME = 1e-6
# Columns of `Model.actuator_muscle_time`: the width within which one goes over into the other.
_WIDTH = 1


class Switches:
    """Names what is at a switch in steps of the worlds of `copies`.

    Args:
        space: The tangent space.
        copies: The worlds.
    """

    def __init__(self, space: TangentSpace, copies: Copies) -> None:
        self._space, self._copies = space, copies

    def of(self, memory: StepMemory, place: int, world: int) -> tuple[str, ...]:
        """Names in the place of a world whose step was linearised."""
        names: tuple[str, ...] = ()
        is_near = memory.near[place] >= 0
        if np.count_nonzero(is_near):
            names = tuple(contact_name(known_as) for known_as in memory.near[place, is_near].tolist())
        return (*names, *self._muscles(world)) if len(self._space.activations) else names

    def _muscles(self, world: int) -> tuple[str, ...]:
        rows = self._space.activations
        model, state = self._copies.model, self._copies.state

        def own(name: str) -> np.ndarray:
            values = model[name]
            return values[world if len(values) > 1 else 0, rows]

        dynamics = model["actuator_dynamics"]
        dynamics = dynamics[rows] if dynamics.ndim == 1 else own("actuator_dynamics")
        control = np.clip(
            state["actuator_control"][world, rows],
            own("actuator_control_lower"),
            own("actuator_control_upper"),
        )
        activation = self._copies.scratch(world)["actuator_start"][rows]
        off = np.abs(np.clip(control, 0.0, 1.0) - activation)
        at_switch = (dynamics == MUSCLE) & (own("actuator_muscle_time")[:, _WIDTH] <= 0.0) & (off <= _SAME)
        return tuple(f"muscle {self._space.actuators[i]}" for i in np.flatnonzero(at_switch).tolist())
