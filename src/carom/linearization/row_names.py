"""Names and status of rows that kernels have added, and what has no exact derivatives among them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.layouts.codes import ShapeKind, UserConstraintKind
from carom.layouts.linearization import (
    ACTUATOR_ROW,
    ANCHOR,
    ANISOTROPY,
    BALL_QUARTER_TURN,
    BASE_FRICTION_ROW,
    BASE_SPRING,
    BOTH_LIMITS,
    BOUNCE,
    CARRIED,
    CONE_SURFACE,
    CONTACT_FRICTION,
    CONTACT_ROW,
    COUPLING_ROW,
    FEATURES,
    FIXED_ROW,
    FRICTION_ROW,
    GEAR_ROW,
    LIMIT_ROW,
    MOTOR_ROW,
    MOVING_BASE,
    OTHER_USER,
    POINT_TO_POINT_ROW,
    PRISMATIC_ROW,
    PULLED,
    QUARTER_TURN,
    ROLLING_FRICTION,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SATURATED,
    ROW_SLIDES,
    ROW_UPPER,
    SHAPE_KINDS,
    SPINNING_FRICTION,
    TENDON_COUPLING_ROW,
    TENDON_FRICTION,
    TENDON_LIMIT,
    TENDON_SPRING,
    TORSION,
    TRANSMISSION_ROW,
)

if TYPE_CHECKING:
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.tangent import TangentSpace

# Whether a row holds, or why its impulse is at a bound.
HOLDS = "holds"
LOWER = "at its lower bound"
UPPER = "at its upper bound"
SATURATED = "at its greatest velocity"
SLIDES = "slides"
_STATUS = {
    ROW_HOLDS: HOLDS,
    ROW_LOWER: LOWER,
    ROW_UPPER: UPPER,
    ROW_SATURATED: SATURATED,
    ROW_SLIDES: SLIDES,
}
_JOINTS = {MOTOR_ROW: "motor", LIMIT_ROW: "limit", FRICTION_ROW: "friction", ACTUATOR_ROW: "actuator"}
_USERS = {
    GEAR_ROW: "gear constraint",
    COUPLING_ROW: "coupling constraint",
    PRISMATIC_ROW: "prismatic constraint",
    FIXED_ROW: "fixed constraint",
    POINT_TO_POINT_ROW: "point to point constraint",
    BASE_FRICTION_ROW: "friction of free body, constraint",
    TENDON_SPRING: "spring of tendon, constraint",
    TENDON_FRICTION: "friction of tendon, constraint",
    TENDON_LIMIT: "limit of tendon, constraint",
    TENDON_COUPLING_ROW: "coupling of tendons, constraint",
    TRANSMISSION_ROW: "actuator of tendon or site, constraint",
}
_CONTACTS = {
    CONTACT_ROW: "",
    CONTACT_FRICTION: "friction of ",
    ROLLING_FRICTION: "rolling friction of ",
    SPINNING_FRICTION: "spinning friction of ",
}
_PROBLEMS_OF_CONTACTS = {
    FEATURES: "{} jumps where positions change, so that it has no derivatives",
    MOVING_BASE: "{} with a fixed base that has a velocity has no exact derivatives: "
    'use method="differences"',
    PULLED: "{}: whether an actuator pulls by a rigid contact with a gap follows from the step before, so "
    'that it has no exact derivatives: use method="differences"',
    ANISOTROPY: "{}: anisotropic friction has no exact derivatives",
    ANCHOR: "{}: friction anchors have no exact derivatives",
    BOUNCE: "{}: a bounce has no exact derivatives",
    TORSION: "{}: rolling and spinning friction have no exact derivatives where bodies are solved in several "
    'groups: use method="differences"',
    CONE_SURFACE: "{}: derivatives by the friction of contacts that yield are not exact with "
    'contact="compliant": use method="differences"',
}
_PROBLEMS = {
    BALL_QUARTER_TURN: "motor of {} is at a quarter turn, where its angles have no derivatives",
    BOTH_LIMITS: "both limits of {} act at once, which has no exact derivatives",
    BASE_SPRING: "spring at the base of {} has no exact derivatives",
}
_MAX_KEPT = 256


class StateWithoutDerivativesError(NotImplementedError):
    """A step has no exact derivatives from this state, but may have some from others."""


class UnmeasuredContactError(StateWithoutDerivativesError):
    """How a contact moves has no closed form, and has not been measured."""


class RowNames:
    """Names of rows, kept for the sets of rows that were met."""

    def __init__(self, space: TangentSpace) -> None:
        self._space = space
        self._known: dict[bytes, tuple[tuple[str, str], ...]] = {}

    def __call__(self, memory: StepMemory, place: int) -> tuple[tuple[str, str], ...]:
        """Name and status of the rows of a place."""
        own = slice(int(memory.row_count[place]))
        parts = [it[place, own] for it in (memory.row_kind, memory.row_status, memory.row_dof)]
        key = b"".join(part.tobytes() for part in parts)
        found = self._known.get(key)
        if found is None:
            if len(self._known) >= _MAX_KEPT:
                self._known.clear()
            rows = zip(*(part.tolist() for part in parts), strict=True)
            found = self._known[key] = tuple(
                (self._name(kind, number), _STATUS[status]) for kind, status, number in rows
            )
        return found

    def _name(self, kind: int, number: int) -> str:
        if kind in _USERS:
            return f"{_USERS[kind]} {number}"
        if kind in _CONTACTS:
            return f"{_CONTACTS[kind]}{contact_name(number)}"
        return f"{_JOINTS[kind]} of {self._space.labels[number][0]}"


def contact_name(known_as: int) -> str:
    """A contact by its number and the kinds of its shapes, see `layouts.linearization.SHAPE_KINDS`."""
    number, kinds = divmod(known_as, SHAPE_KINDS**2)
    described = " and ".join(ShapeKind(kind).name.lower() for kind in divmod(kinds, SHAPE_KINDS))
    return f"contact {number} of {described}"


def raise_problem(problem: int, space: TangentSpace, number: int) -> None:
    """Raise `NotImplementedError` for what a kernel has found of a dof, a user constraint or a contact."""
    if problem == OTHER_USER:
        raise NotImplementedError(
            f"user constraints of the kind {UserConstraintKind(number).name} have no exact derivatives"
        )
    if problem == QUARTER_TURN:
        raise StateWithoutDerivativesError(
            f"user constraint {number} is a quarter turn off, where its angles have no derivatives"
        )
    if problem == CARRIED:
        raise StateWithoutDerivativesError(
            f"user constraint {number} holds a fixed base that has a velocity, which has no exact "
            'derivatives: use method="differences"'
        )
    if problem in _PROBLEMS_OF_CONTACTS:
        kind = UnmeasuredContactError if problem == FEATURES else StateWithoutDerivativesError
        raise kind(_PROBLEMS_OF_CONTACTS[problem].format(contact_name(number)))
    of_state = problem in (BALL_QUARTER_TURN, BOTH_LIMITS)
    kind = StateWithoutDerivativesError if of_state else NotImplementedError
    raise kind(_PROBLEMS[problem].format(space.labels[number][0]))
