"""The actuators of a body in many worlds: controls, activations, forces and parameters."""

from __future__ import annotations

from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.description.actuator import ActuatorSpec
from carom.native.gates import gated
from carom.scene.common.actuator import OF_BIAS, CommonActuator
from carom.scene.sensors.joints import along_actuator
from carom.scene.sensors.source import Source
from carom.worlds.batch import Batch
from carom.worlds.chosen import Where
from carom.worlds.parts.joint import JointBatch
from carom.worlds.parts.joints import JointGroupBatch
from carom.worlds.parts.part import Parts, SensedPart

# Parameters that can differ between worlds, by the names of `ActuatorBatch.change`; those of servos are terms
# of gain and bias.
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
_RANGES = "control_range", "force_range", "activation_range", "joint_range"
_BOUNDS = tuple(name for name in _FIELDS if name.endswith(("_lower", "_upper")))


class ActuatorBatch(
    CommonActuator[Array, "ArrayLike", tuple[Array, Array], "tuple[ArrayLike, ArrayLike]"], SensedPart
):
    """One actuator of a body in all worlds; get it from `worlds[body].actuators`.

    Names are those of `BodyActuator`; numbers have the world as their first axis.

    Attributes:
        index: Its number among the actuators of the body.
        name: Its name.
    """

    __slots__ = ()

    @property
    def spec(self) -> ActuatorSpec:
        """What it was made from."""
        return self._batch._body.spec.actuators[self.index]

    @property
    def joint(self) -> JointBatch:
        """The joint that it drives; raises `KeyError` if it drives a tendon or acts at a site."""
        return JointGroupBatch(self._batch)[self.spec.joint]

    @property
    def control(self) -> Array:
        """The control, a view (count,), which stays until it is set again; settable."""
        return self._batch._state["actuator_control"][:, self._row]

    @control.setter
    def control(self, value: ArrayLike) -> None:
        self._set("actuator_control", value, "control")

    @property
    def activation(self) -> Array:
        """The activation, a state of actuators with dynamics, a view (count,); settable."""
        return self._batch._state["actuator_activation"][:, self._row]

    @activation.setter
    def activation(self, value: ArrayLike) -> None:
        self._set("actuator_activation", value, "activation")

    @property
    def force(self) -> Array:
        """Its force in the last substep, within its range [N or N m], a view (count,)."""
        return self._batch._state["actuator_force"][:, self._row]

    @property
    @gated("_batch._scene.call_lock")
    def length(self) -> Array:
        """`gear` times the position of its joint or the length of its tendon, (count,)."""
        return np.array(along_actuator(self._source, self._batch._body, self.index)[0])

    @property
    @gated("_batch._scene.call_lock")
    def velocity(self) -> Array:
        """The rate of its length, (count,)."""
        return np.array(along_actuator(self._source, self._batch._body, self.index)[1])

    @gated("_batch._scene.call_lock", section=True)
    def change(self, *, where: Where | None = None, **changes: ArrayLike) -> None:
        """Change parameters in each world.

        Args:
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            **changes: One value for all, or one for each of the n worlds chosen: `kp` and `kv` of a servo,
                `gear`, `gain` (n, 3), `bias` (n, 3), `time_constant`, `control_lower`, `control_upper`,
                `force_lower`, `force_upper`, `activation_lower`, `activation_upper`, `joint_lower`,
                `joint_upper`, or two of these as `control_range`, `force_range`, `activation_range` and
                `joint_range`, a pair of such values; see `ActuatorSpec`. Of several actuators of a joint,
                ranges of the joint are those of the first one.

        Raises:
            ValueError: A gear is 0, a time constant is not greater than 0, or there are not as many values
                as worlds chosen.
            TypeError: There is no such parameter.
        """
        for name in [name for name in changes if name in _RANGES]:
            lower, upper = cast("tuple[ArrayLike, ArrayLike]", changes.pop(name))
            changes |= {name.replace("_range", "_lower"): lower, name.replace("_range", "_upper"): upper}
        unknown = [name for name in changes if name not in (*_FIELDS, *OF_BIAS)]
        if unknown:
            known = ", ".join((*OF_BIAS, *_FIELDS, *_RANGES))
            raise TypeError(f"actuators have no parameter {unknown[0]!r}; they have {known}")
        batch, worlds = self._batch, self._batch._chosen(where)
        servo = {name: changes.pop(name) for name in OF_BIAS if name in changes}
        if servo and "bias" in changes:
            raise TypeError(f"{next(iter(servo))} is a part of bias: give one of them")
        gains = {
            name: worlds.values(np.asarray(batch._take(value)), (), name) for name, value in servo.items()
        }
        for name, numbers in gains.items():
            if (numbers < 0.0).any():
                raise ValueError(f"{name} must not be negative")
        values = {
            name: worlds.values(
                np.asarray(batch._take(value)), (3,) if name in _VECTORS else (), name,
                finite=name not in _BOUNDS,
            )
            for name, value in changes.items()
        }  # fmt: skip
        if "gear" in values and not values["gear"].all():
            raise ValueError("gear must not be 0")
        if "time_constant" in values and not (values["time_constant"] > 0.0).all():
            raise ValueError("time_constant must be greater than 0")
        for name, numbers in values.items():
            batch._engine.set_parameter("model", _FIELDS[name], self._row, numbers, worlds.rows)
        for name, numbers in gains.items():
            self._change_servo(worlds.rows, OF_BIAS[name], numbers)

    def _change_servo(self, rows: slice | np.ndarray, place: int, value: Array) -> None:
        """Set the stiffness or the damping of a servo; its control counts as its stiffness does."""
        bias, gain = self._parameter("bias")[rows], self._parameter("gain")[rows]
        # Of a velocity servo the control is a velocity.
        scaled = gain[:, 0] == -bias[:, place]
        bias[:, place] = -value
        gain[:, 0] = np.where(scaled, value, gain[:, 0])
        for name, numbers in (("bias", bias), ("gain", gain)):
            self._batch._engine.set_parameter("model", _FIELDS[name], self._row, numbers, rows)

    def _set(self, field: str, value: ArrayLike, name: str) -> None:
        batch = self._batch
        with batch._scene.call_lock:
            # One statement.
            batch._state[field][:, self._row] = batch._chosen().values(batch._take(value), (), name)

    def _of_servo(self, place: int) -> Array:
        return -self._parameter("bias")[:, place]

    def _bounds(self, of: str) -> tuple[Array, Array]:
        return self._parameter(f"{of}_lower"), self._parameter(f"{of}_upper")

    def _parameter(self, name: str) -> Array:
        with self._batch._scene.call_lock:
            return np.array(self._batch._engine.parameter("model", _FIELDS[name], self._row))

    @property
    def _row(self) -> int:
        return self._batch._actuators.start + self.index


class ActuatorBatches(Parts[ActuatorBatch]):
    """All actuators of a body in all worlds: `actuators["elbow"]`, and arrays over all of them."""

    def __init__(self, batch: Batch, source: Source) -> None:
        count = len(batch._body.spec.actuators)
        super().__init__("actuator", [ActuatorBatch(batch, source, index) for index in range(count)])
        self._batch = batch

    @property
    def controls(self) -> Array:
        """Controls of the actuators, a view (count, actuators); they can be set."""
        return self._batch._state["actuator_control"][:, self._batch._actuators]

    @controls.setter
    def controls(self, values: ArrayLike) -> None:
        self._fill(self.controls, values, "controls")

    @property
    def activations(self) -> Array:
        """Activations of the actuators, a view (count, actuators); 0 of those without dynamics."""
        return self._batch._state["actuator_activation"][:, self._batch._actuators]

    @activations.setter
    def activations(self, values: ArrayLike) -> None:
        self._fill(self.activations, values, "activations")

    @property
    def forces(self) -> Array:
        """Forces of the actuators in the last substep [N or N m], a view (count, actuators)."""
        return self._batch._state["actuator_force"][:, self._batch._actuators]

    @gated("_batch._scene.call_lock")
    def _fill(self, view: Array, values: ArrayLike, name: str) -> None:
        view[:] = self._batch._chosen().values(self._batch._take(values), view.shape[1:], name)
