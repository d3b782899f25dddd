"""Rows of actuators in the flat arrays: writing and reading them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from math import inf
from typing import TYPE_CHECKING, Any

from carom.errors import DescriptionError

if TYPE_CHECKING:
    from carom.description.actuator import ActuatorSpec
    from carom.model.body_spec import BodySpec

_BOUNDS = ("control", "force", "activation", "joint")
_UNBOUNDED = (-inf, inf)


def write_actuator(model: Mapping[str, Any], row: int, spec: ActuatorSpec) -> None:
    """Write the parameters of an actuator."""
    model["actuator_dynamics"][row] = spec.dynamics
    model["actuator_gain"][:, row] = spec.gain
    model["actuator_bias"][:, row] = spec.bias
    model["actuator_gear"][:, row] = spec.gear
    model["actuator_time_constant"][:, row] = spec.time_constant
    muscle = spec.muscle
    model["actuator_is_muscle"][row] = muscle is not None
    model["actuator_is_early"][row] = spec.acts_early
    if muscle is not None:
        model["actuator_muscle"][:, row] = (
            muscle.force,
            muscle.fibre,
            muscle.tendon,
            muscle.shortest,
            muscle.longest,
            muscle.speed,
            muscle.passive,
            muscle.lengthening,
        )
        model["actuator_muscle_time"][:, row] = (muscle.fall_time, muscle.smoothing, 0.0)
    for name in _BOUNDS:
        lower, upper = getattr(spec, f"{name}_range")
        model[f"actuator_{name}_lower"][:, row] = lower
        model[f"actuator_{name}_upper"][:, row] = upper


def pulled_link(body: BodySpec, spec: ActuatorSpec) -> int:
    """What `ActuatorModel.pulled` is of an actuator of a body.

    Raises:
        DescriptionError: There is no such link.
    """
    if not spec.link:
        return 0
    names = [link.name for link in (body.base, *body.links)]
    if spec.link not in names:
        known = ", ".join(map(repr, names))
        raise DescriptionError(f"actuator {spec.name!r}: there is no link {spec.link!r}; there are {known}")
    return 1 + names.index(spec.link)


def check_joint_ranges(specs: Iterable[ActuatorSpec]) -> None:
    """Raise `DescriptionError` if two actuators of a joint or tendon have different bounds of their sum."""
    first: dict[tuple[str, str], ActuatorSpec] = {}
    for spec in specs:
        other = first.setdefault(driven := (spec.joint, spec.tendon), spec)
        if any(driven) and other.joint_range != spec.joint_range:
            kind = "joint" if spec.joint else "tendon"
            raise DescriptionError(
                f"actuator {spec.name!r}: joint_range must be that of {other.name!r}, "
                f"which drives {kind} {spec.joint or spec.tendon!r} as well"
            )


def join_actuators(model: Mapping[str, Any], first: int, specs: Sequence[ActuatorSpec]) -> None:
    """Chain the actuators of each joint and tendon with bounds of their sum; they are those of a body."""
    known: dict[tuple[str, str], list[int]] = {}
    for number, spec in enumerate(specs):
        model["actuator_follows"][first + number] = model["actuator_to_next"][first + number] = 0
        driven = spec.joint, spec.tendon
        others = known.setdefault(driven, [])
        if any(driven) and others and spec.joint_range != _UNBOUNDED:
            model["actuator_follows"][first + number] = number - others[0]
            model["actuator_to_next"][first + others[-1]] = number - others[-1]
        others.append(number)


def read_actuator(model: dict[str, Any], row: int, world: int, spec: ActuatorSpec) -> ActuatorSpec:
    """An actuator with the parameters that it has in a world."""

    def value(name: str) -> Any:
        array = model[f"actuator_{name}"]
        return array[world if len(array) > 1 else 0, row].tolist()

    return replace(
        spec,
        gain=tuple(value("gain")),
        bias=tuple(value("bias")),
        gear=value("gear"),
        time_constant=value("time_constant"),
        **{f"{name}_range": (value(f"{name}_lower"), value(f"{name}_upper")) for name in _BOUNDS},
    )
