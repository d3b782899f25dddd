"""What an actuator has in one world and in many: its parameters."""

from __future__ import annotations

from typing import Any, Generic, TypeVar

Number = TypeVar("Number")
Given = TypeVar("Given")
Bounds = TypeVar("Bounds")
GivenBounds = TypeVar("GivenBounds")

OF_BIAS = {"kp": 1, "kv": 2}
"""Parameters of servos: the place in the bias, of which they are the negative."""


class CommonActuator(Generic[Number, Given, Bounds, GivenBounds]):
    """Parameters of an actuator; in one world numbers are plain, in many they are copies (count,)."""

    __slots__ = ()

    @property
    def gear(self) -> Number:
        """Length per position of the joint; settable, as those below are."""
        return self._parameter("gear")

    @gear.setter
    def gear(self, value: Given) -> None:
        self.change(gear=value)

    @property
    def kp(self) -> Number:
        """Stiffness of a servo: by how much its force falls with its length."""
        return self._of_servo(OF_BIAS["kp"])

    @kp.setter
    def kp(self, value: Given) -> None:
        self.change(kp=value)

    @property
    def kv(self) -> Number:
        """Damping of a servo: by how much its force falls with its velocity."""
        return self._of_servo(OF_BIAS["kv"])

    @kv.setter
    def kv(self, value: Given) -> None:
        self.change(kv=value)

    @property
    def control_range(self) -> Bounds:
        """Bounds of the control."""
        return self._bounds("control")

    @control_range.setter
    def control_range(self, value: GivenBounds) -> None:
        self.change(control_range=value)

    @property
    def force_range(self) -> Bounds:
        """Bounds of the force [N or N m]."""
        return self._bounds("force")

    @force_range.setter
    def force_range(self, value: GivenBounds) -> None:
        self.change(force_range=value)

    def change(self, **changes: Any) -> None:
        """Change parameters."""
        raise NotImplementedError

    def _parameter(self, name: str) -> Number:
        raise NotImplementedError

    def _of_servo(self, place: int) -> Number:
        """The negative of a number of the bias."""
        raise NotImplementedError

    def _bounds(self, of: str) -> Bounds:
        raise NotImplementedError
