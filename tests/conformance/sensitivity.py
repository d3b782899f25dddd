"""How far a last-bit difference grows in each scenario.

    .oracle/bin/python -m tests.conformance.sensitivity [--nudge 1e-13] [--only NAME ...]

A motion that amplifies rounding (chaos, or a solver on the edge of stopping one iteration
earlier) says nothing about an engine. Every scenario is run twice, the second time with gravity,
reset states and forces changed by a relative nudge; the growth is the relative error this causes,
divided by the nudge. Scenarios whose growth would lift rounding near the tolerance need a shorter
or tamer motion.
"""

from __future__ import annotations

import argparse
import importlib
from typing import Any

from .catalogue import select
from .compare import relative_errors
from .scenario import Kind, Scenario

_NUDGED = {
    "setGravity",
    "resetJointState",
    "resetBaseVelocity",
    "applyExternalForce",
    "applyExternalTorque",
    "setJointMotorControl2",
    "changeDynamics",
}
# Rounding is about 1e-16 a step and adds up over some hundred steps.
_ACCUMULATED_ROUNDING = 1e-13


class Nudged:
    """A `pybullet` module whose physical inputs are off by a relative nudge."""

    def __init__(self, pybullet: Any, nudge: float) -> None:
        self._pybullet = pybullet
        self._nudge = nudge

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(self._pybullet, name)
        if name not in _NUDGED:
            return attribute

        def call(*arguments: Any, **options: Any) -> Any:
            return attribute(
                *(self._shift(value) for value in arguments),
                **{key: self._shift(value) for key, value in options.items()},
            )

        return call

    def _shift(self, value: Any) -> Any:
        if isinstance(value, float):
            return value * (1.0 + self._nudge)
        if isinstance(value, (list, tuple)):
            return [self._shift(item) for item in value]
        return value


def growth(scenario: Scenario, pybullet: Any, nudge: float) -> tuple[str, float]:
    """The most sensitive series of a scenario and its relative error per nudge."""
    plain = scenario.series(pybullet)
    nudged = scenario.series(Nudged(pybullet, nudge))  # type: ignore[arg-type]
    errors = {
        name: float(relative_errors(plain[name], nudged[name], by_row=False).max(initial=0.0)) / nudge
        for name in plain
        if plain[name].dtype.kind == "f"
    }
    return max(errors.items(), key=lambda item: item[1])


def main() -> None:
    """Print the growth of every motion, the worst last."""
    parser = argparse.ArgumentParser(description="Measure how scenarios amplify rounding.")
    parser.add_argument("--nudge", type=float, default=1e-13, help="relative change of the inputs")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    arguments = parser.parse_args()
    pybullet = importlib.import_module("pybullet")
    found = [
        (*growth(scenario, pybullet, arguments.nudge), scenario.name)
        for scenario in select(arguments.only)
        if scenario.kind is Kind.MOTION
    ]
    for series, factor, name in sorted(found, key=lambda item: item[1]):
        print(f"{factor:10.3g}  rounding grows to {factor * _ACCUMULATED_ROUNDING:8.1e}  {name}: {series}")


if __name__ == "__main__":
    main()
