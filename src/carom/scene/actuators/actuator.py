"""One actuator of a body, and all of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite, one_or_each
from carom.description.actuator import ActuatorSpec, Range
from carom.native.change import first_change
from carom.native.gates import gated
from carom.scene.actuators.actuated_joint import drives_joint
from carom.scene.common.actuator import CommonActuator
from carom.scene.handles import world_of
from carom.scene.named import Named
from carom.scene.sensors.joints import along_actuator
from carom.scene.sensors.lone_source import LoneSource

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.joint import Joint


class BodyActuator(CommonActuator[float, float, Range, Range]):
    """One actuator of a body; lengths and forces are its own, `gear` relates them to those of its joint.

    Attributes:
        body: The body.
        index: Its number among the actuators of the body.
    """

    __slots__ = ("body", "index")

    def __init__(self, body: Body, index: int) -> None:
        self.body: Body = body
        self.index: int = index

    def __repr__(self) -> str:
        spec = self.spec
        what = f"tendon {spec.tendon!r}" if spec.tendon else f"site {spec.site!r}"
        what = f"link {spec.link!r}" if spec.link else what
        what = f"joint {spec.joint!r}" if drives_joint(spec) else what
        return f"<Actuator {self.index} {self.name!r} of {self.body.name!r}: {what}>"

    @property
    def spec(self) -> ActuatorSpec:
        """What it was made from."""
        return self.body.spec.actuators[self.index]

    @property
    def name(self) -> str:
        """Its name."""
        return self.spec.name

    @property
    def joint(self) -> Joint:
        """The joint that it drives; raises `KeyError` if it drives a tendon or acts at a site."""
        return self.body.joints[self.spec.joint]

    @property
    @gated("body.world.call_lock")
    def control(self) -> float:
        """The control, which stays until it is set again; settable. Its range bounds what has an effect."""
        return float(self._state("actuator_control")[self._row])

    @control.setter
    @gated("body.world.call_lock", commits=True)
    def control(self, value: float) -> None:
        change = first_change()
        row = self._row
        change.write(self._state("actuator_control")[row : row + 1], float(finite(value, "control")))
        change.commit()

    @property
    @gated("body.world.call_lock")
    def activation(self) -> float:
        """The activation, a state of actuators with dynamics; settable."""
        return float(self._state("actuator_activation")[self._row])

    @activation.setter
    @gated("body.world.call_lock", commits=True)
    def activation(self, value: float) -> None:
        change = first_change()
        row = self._row
        change.write(self._state("actuator_activation")[row : row + 1], float(finite(value, "activation")))
        change.commit()

    @property
    @gated("body.world.call_lock")
    def force(self) -> float:
        """Its force in the last substep, within its range [N or N m]; the joint feels `gear` times that."""
        return float(self._state("actuator_force")[self._row])

    @property
    @gated("body.world.call_lock")
    def length(self) -> float:
        """`gear` times the position of its joint or the length of its tendon; of sites see `ActuatorSpec`."""
        return float(along_actuator(LoneSource(world_of(self.body)), self.body, self.index)[0][0])

    @property
    @gated("body.world.call_lock")
    def velocity(self) -> float:
        """The rate of its length."""
        return float(along_actuator(LoneSource(world_of(self.body)), self.body, self.index)[1][0])

    def change(self, **changes: Any) -> None:
        """Change parameters, all at once.

        Args:
            **changes: `kp` and `kv` of a servo, whose control counts as its stiffness does; or `gear`,
                `gain`, `bias`, `time_constant`, `control_range`, `force_range`, `activation_range` and
                `joint_range` of `ActuatorSpec`.

        Raises:
            TypeError: There is no such parameter.
            ValueError: A gain is negative or not finite.
            carom.errors.DescriptionError: A number has no meaning; the actuator stays as it was.
        """
        from carom.scene.actuators.changes import change_actuator

        change_actuator(self.body, self.index, changes)

    def _parameter(self, name: str) -> float:
        return getattr(self.spec, name)

    def _of_servo(self, place: int) -> float:
        return -self.spec.bias[place]

    def _bounds(self, of: str) -> Range:
        return getattr(self.spec, f"{of}_range")

    def _state(self, name: str) -> Array:
        return world_of(self.body).arrays.state.numpy[name][0]

    @property
    def _row(self) -> int:
        return self.body.rows.first["actuator"] + self.index


class BodyActuators(Named[BodyActuator]):
    """All actuators of a body: `actuators["elbow"]`, `actuators[0]`, and arrays over all of them."""

    def __init__(self, body: Body) -> None:
        super().__init__("actuator", [BodyActuator(body, i) for i in range(len(body.spec.actuators))])
        self._body = body

    def __repr__(self) -> str:
        return f"<Actuators of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"

    @property
    @gated("_body.world.call_lock")
    def controls(self) -> Array:
        """The controls of all, a copy; settable, by one number for each or one for all."""
        return self._state("actuator_control").copy()

    @controls.setter
    @gated("_body.world.call_lock", commits=True)
    def controls(self, values: ArrayLike) -> None:
        change = first_change()
        numbers = one_or_each(finite(values, "controls"), len(self), "controls")
        change.write(self._state("actuator_control"), numbers)
        change.commit()

    @property
    @gated("_body.world.call_lock")
    def activations(self) -> Array:
        """The activations of all, a copy; settable."""
        return self._state("actuator_activation").copy()

    @activations.setter
    @gated("_body.world.call_lock", commits=True)
    def activations(self, values: ArrayLike) -> None:
        change = first_change()
        numbers = one_or_each(finite(values, "activations"), len(self), "activations")
        change.write(self._state("actuator_activation"), numbers)
        change.commit()

    @property
    @gated("_body.world.call_lock")
    def forces(self) -> Array:
        """The forces of all in the last substep, a copy."""
        return self._state("actuator_force").copy()

    def _state(self, name: str) -> np.ndarray:
        first = self._body.rows.first["actuator"]
        return world_of(self._body).arrays.state.numpy[name][0, first : first + len(self)]
