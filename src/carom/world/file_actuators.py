"""Actuators of MJCF files whose numbers follow from what they move: forces of muscles, damping of servos."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from carom.model.actuator_rows import write_actuator
from carom.scene.handles import world_of
from carom.world.reference_masses import ReferenceMasses

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.scene.core.body_core import BodyCore

_LEAST = 1e-15


def find_numbers(bodies: Sequence[BodyCore], damping_ratios: Mapping[str, float]) -> None:
    """Find the forces of muscles stated as accelerations, and the damping of servos stated as a ratio.

    All that is where the bodies are now, by MuJoCo's rules. The force of a muscle is the acceleration over
    the length of the vector of accelerations that a force of 1 causes, of all coordinates. The damping of a
    servo is its ratio times the critical one for the mass that it moves: the inverse of the acceleration
    along it that a force of 1 causes.

    Args:
        bodies: The bodies with their actuators.
        damping_ratios: By name of the actuator.
    """
    for body in bodies:
        masses: ReferenceMasses | None = None
        for number, spec in enumerate(body.spec.actuators):
            ratio = damping_ratios.get(spec.name, 0.0)
            if not ratio and (spec.muscle is None or spec.muscle.force >= 0.0):
                continue
            masses = masses or ReferenceMasses(body)
            found = _found(spec, masses, number, ratio)
            others = [found if it is spec else it for it in body.spec.actuators]
            body.spec = replace(body.spec, actuators=tuple(others))
            row = body.rows.first["actuator"] + number
            write_actuator(world_of(body).arrays.model.numpy, row, found)


def _found(spec: ActuatorSpec, masses: ReferenceMasses, number: int, ratio: float) -> ActuatorSpec:
    effect = masses.of(number)
    if spec.muscle is not None:
        force = -spec.muscle.force / max(masses.norm(effect), _LEAST)
        return replace(spec, muscle=replace(spec.muscle, force=force))
    force, stiffness, _ = spec.bias
    inverse_mass = effect.inverse_mass
    mass = 1.0 / inverse_mass if inverse_mass > _LEAST else 0.0
    return replace(spec, bias=(force, stiffness, -2.0 * ratio * (spec.gain[0] * mass) ** 0.5))
