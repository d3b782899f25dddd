"""`<dcmotor>`: motors whose control is a voltage, as torque constant, resistance and greatest torque.

A current that follows its voltage at once makes the torque K u / R - K² v / R, with the velocity v: a gain
and a damping. What makes other states or another law is named as missing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from carom.formats.mjcf.defaults import Attributes

_INPUTS = "input"
# Attributes with another law: how many numbers they have, and of how many first ones one is not 0 then.
_OF_OTHER_LAWS = {
    "inductance": (2, 2),
    "cogging": (3, 1),
    "thermal": (6, 6),
    "lugre": (5, 5),
    "controller": (6, 6),
}


@dataclass(frozen=True, slots=True)
class DcMotor:
    """What a motor has so far, by its attributes and those of its defaults.

    Attributes:
        constant: Torque per current, which is also voltage per velocity [N m/A, or V s/rad]; 0 if unknown.
        resistance: [V/A]; 0 if unknown.
        torque: Greatest torque [N m]; 0 for none.
        missing: Names of attributes whose law is not built.
    """

    constant: float = 0.0
    resistance: float = 0.0
    torque: float = 0.0
    missing: tuple[str, ...] = ()

    def problem(self) -> str:
        """What is wrong with it; empty if nothing is."""
        if self.missing:
            return ""
        if self.constant <= 0.0:
            return "a dcmotor needs a positive motorconst, or a nominal voltage and velocity"
        if self.resistance <= 0.0:
            return "a dcmotor needs a positive resistance, or a nominal voltage and torque"
        return ""

    def with_attributes(
        self, attributes: Attributes, numbers: Callable[[str, str, int], list[float]]
    ) -> DcMotor:
        """It with the attributes of an element or of defaults."""

        def several(name: str, most: int) -> list[float]:
            found = numbers(name, attributes[name], most) if name in attributes else []
            return [*found, *(0.0,) * most][:most]

        stated = [it for it in several("motorconst", 2) if it > 0.0]
        constant = (stated[0] * stated[-1]) ** 0.5 if stated else self.constant
        resistance = several("resistance", 1)[0] if "resistance" in attributes else self.resistance
        voltage, stall, fastest = several("nominal", 3)
        if voltage > 0.0 and fastest > 0.0:
            constant = (constant * voltage / fastest) ** 0.5 if constant > 0.0 else voltage / fastest
        if voltage > 0.0 and stall > 0.0 and "resistance" not in attributes and resistance == 0.0:
            resistance = constant * voltage / stall
        greatest, current, _slew = several("saturation", 3)
        torque = greatest if greatest > 0.0 else constant * current
        missing = [it for it in self.missing if it not in attributes]
        missing += [
            name
            for name, (most, count) in _OF_OTHER_LAWS.items()
            if name in attributes and any(several(name, most)[:count])
        ]
        if attributes.get(_INPUTS, "voltage").split() != ["voltage"]:
            missing.append(_INPUTS)
        return replace(
            self,
            constant=constant,
            resistance=resistance,
            torque=torque if torque > 0.0 else self.torque,
            missing=tuple(missing),
        )
