"""The actuators of a body in many worlds: controls, activations, forces and parameters."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.native.gates import alone, in_section
from carom.worlds.batch import Batch
from carom.worlds.chosen import choose

# Parameters that can differ between worlds, by the names of `change_actuator`; those of servos are terms of
# gain and bias.
_FIELDS = {
    "gear": "actuator_gear",
    "gain": "actuator_gain",
    "bias": "actuator_bias",
    "time_constant": "actuator_time_constant",
    "control_lower": "actuator_control_lower",
    "control_upper": "actuator_control_upper",
    "force_lower": "actuator_force_lower",
    "force_upper": "actuator_force_upper",
    "joint_lower": "actuator_joint_lower",
    "joint_upper": "actuator_joint_upper",
    "activation_lower": "actuator_activation_lower",
    "activation_upper": "actuator_activation_upper",
}
_VECTORS = ("gain", "bias")
_BOUNDS = tuple(name for name in _FIELDS if name.endswith(("_lower", "_upper")))


class ActuatorBatch(Batch):
    """The part of `BodyBatch` that is about actuators."""

    @property
    def actuator_names(self) -> list[str]:
        """Names of the actuators, in the order of the arrays."""
        return [spec.name for spec in self._body.spec.actuators]

    @property
    def controls(self) -> Array:
        """Controls of the actuators, a view (count, actuators)."""
        return self._state["actuator_control"][:, self._actuators]

    @controls.setter
    @alone("_scene.call_lock")
    def controls(self, value: ArrayLike) -> None:
        view = self.controls
        view[:] = self._chosen().values(self._take(value), view.shape[1:], "controls")

    @property
    def activations(self) -> Array:
        """Activations of the actuators, a view (count, actuators); 0 of those without dynamics."""
        return self._state["actuator_activation"][:, self._actuators]

    @property
    def actuator_forces(self) -> Array:
        """Forces of the actuators in the last substep [N or N m], a view (count, actuators)."""
        return self._state["actuator_force"][:, self._actuators]

    @in_section("_scene.call_lock")
    def change_actuator(
        self, actuator: int | str, *, where: ArrayLike | None = None, **changes: ArrayLike
    ) -> None:
        """Change parameters of an actuator in each world.

        Args:
            actuator: The actuator by index or name.
            where: Which worlds: a mask (count,) or their indices; None for all.
            **changes: One value for all, or one for each of the n worlds chosen: `gear`, `gain` (n, 3),
                `bias` (n, 3), `time_constant`, `control_lower`, `control_upper`, `force_lower`,
                `force_upper`, `activation_lower`, `activation_upper`, `joint_lower`, `joint_upper`; see
                `ActuatorSpec`. Of several actuators of a joint, the last two are those of the first one.

        Raises:
            ValueError: A gear is 0, a time constant is not greater than 0, or there are not as many values
                as worlds chosen.
            TypeError: There is no such parameter.
        """
        unknown = [name for name in changes if name not in _FIELDS]
        if unknown:
            raise TypeError(f"actuators have no parameter {unknown[0]!r}; they have {', '.join(_FIELDS)}")
        row = self._actuators.start + choose("actuator", self.actuator_names, actuator)
        worlds = self._chosen(where)
        values = {
            name: worlds.values(
                np.asarray(self._take(value)), (3,) if name in _VECTORS else (), name,
                finite=name not in _BOUNDS,
            )
            for name, value in changes.items()
        }  # fmt: skip
        if "gear" in values and not values["gear"].all():
            raise ValueError("gear must not be 0")
        if "time_constant" in values and not (values["time_constant"] > 0.0).all():
            raise ValueError("time_constant must be greater than 0")
        for name, numbers in values.items():
            self._engine.set_parameter("model", _FIELDS[name], row, numbers, worlds.rows)
