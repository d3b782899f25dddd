"""Rates of activations, as `kernels.integrators.runge_kutta` has them, with their derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import FILTER, FILTER_EXACT, INTEGRATOR, MUSCLE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.linearization.inputs import Input

# So small that its square vanishes.
_SMALL = 1e-40
_SHORTEST_TIME = 1e-15


class ActivationRates:
    """Rates of the activations of a world whose controls stay as they are.

    Args:
        model: Fields of its model.
        actuators: Rows of the actuators with activations, (a,).
        controls: Controls of all actuators.
        inputs: Controls and parameters.
    """

    def __init__(
        self,
        model: dict[str, np.ndarray],
        actuators: np.ndarray,
        controls: np.ndarray,
        inputs: Sequence[Input],
    ) -> None:
        self._dynamics = model["actuator_dynamics"][actuators]
        self._constants = model["actuator_time_constant"][actuators]
        self._muscles = model["actuator_muscle_time"][actuators]
        lower, upper = model["actuator_control_lower"][actuators], model["actuator_control_upper"][actuators]
        own = controls[actuators]
        self._controls = np.clip(own, lower, upper)
        self.by_inputs: np.ndarray = np.zeros((len(actuators), len(inputs)))
        """How the bounded controls change with inputs, (a, inputs)."""
        rows = {int(row): place for place, row in enumerate(actuators)}
        for column, given in enumerate(inputs):
            place = rows.get(given.place[0], -1) if given.field == "actuator_control" else -1
            if place >= 0 and lower[place] <= own[place] <= upper[place]:
                self.by_inputs[place, column] = given.scale

    def of(self, activations: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Rates (a,) [1/s], and their derivatives by activations and by bounded controls, (a,) each."""
        found = np.zeros((3, len(activations)))
        for place, activation in enumerate(activations.tolist()):
            control = float(self._controls[place])
            by_activation = self._rate(place, control, activation + 1j * _SMALL)
            by_control = self._rate(place, control + 1j * _SMALL, activation)
            found[:, place] = by_control.real, by_activation.imag / _SMALL, by_control.imag / _SMALL
        return found[0], found[1], found[2]

    def durations(self, time_step: float) -> np.ndarray:
        """For how long the mean rates of a substep act, (a,) [s]."""
        constants = np.where(self._dynamics == FILTER_EXACT, self._constants, 1.0)
        exact = constants * -np.expm1(-time_step / constants)
        return np.where(self._dynamics == FILTER_EXACT, exact, time_step)

    def _rate(self, place: int, control: complex, activation: complex) -> complex:
        dynamics, constant = self._dynamics[place], self._constants[place]
        if dynamics == INTEGRATOR:
            return complex(control)
        if dynamics in (FILTER, FILTER_EXACT):
            return complex((control - activation) / constant)
        if dynamics != MUSCLE:
            return 0j
        falling, width = self._muscles[place][:2]
        scale = 0.5 + 1.5 * _between(activation)
        up, down = constant * scale, falling / scale
        difference = _between(control) - activation
        share: complex = 1.0 if difference.real > 0.0 else 0.0
        if width > 0.0:
            x = _between(difference / width + 0.5)
            share = x * x * x * (x * (6.0 * x - 15.0) + 10.0)
        time = down + (up - down) * share
        return complex(difference / (time if time.real > _SHORTEST_TIME else _SHORTEST_TIME))


def _between(number: complex) -> complex:
    """A number within 0 and 1."""
    return complex(0.0 if number.real < 0.0 else 1.0 if number.real > 1.0 else number)
