"""Names and status of rows that kernels have added, and what has no exact derivatives among them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.layouts.linearization import (
    ACTUATOR_ROW,
    BALL_LIMIT,
    BASE_SPRING,
    BOUNDED_SUM,
    COUPLING_ROW,
    FRICTION_ROW,
    GEAR_ROW,
    LIMIT_ROW,
    MOTOR_ROW,
    MUSCLE_ROW,
    ROW_HOLDS,
    ROW_LOWER,
    ROW_SATURATED,
    ROW_UPPER,
    YIELDING_FRICTION,
    YIELDING_LIMIT,
    YIELDING_USER,
)
from carom.linearization.rows import HOLDS, LOWER, SATURATED, UPPER

if TYPE_CHECKING:
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.tangent import TangentSpace

_STATUS = {ROW_HOLDS: HOLDS, ROW_LOWER: LOWER, ROW_UPPER: UPPER, ROW_SATURATED: SATURATED}
_JOINTS = {MOTOR_ROW: "motor", LIMIT_ROW: "limit", FRICTION_ROW: "friction", ACTUATOR_ROW: "actuator"}
_TIES = {GEAR_ROW: "gear constraint", COUPLING_ROW: "coupling constraint"}
_PROBLEMS = {
    YIELDING_LIMIT: "limit of {} yields, so that it has no exact derivatives",
    YIELDING_FRICTION: "friction of {} yields, so that it has no exact derivatives",
    BALL_LIMIT: "limit of {}, a spherical joint, has no exact derivatives",
    MUSCLE_ROW: "actuator of {} is a muscle, which has no exact derivatives",
    BOUNDED_SUM: "actuators of {} have a bound of their sum; that has no exact derivatives",
    BASE_SPRING: "spring at the base of {} has no exact derivatives",
}
_MOST_KEPT = 256


class RowNames:
    """Names of rows, kept for the sets of rows that were met."""

    def __init__(self, space: TangentSpace) -> None:
        self._space = space
        self._known: dict[bytes, tuple[tuple[str, str], ...]] = {}

    def __call__(
        self, memory: StepMemory, place: int, pairs: list[tuple[str, str]]
    ) -> tuple[tuple[str, str], ...]:
        """Name and status of the rows of a place; `pairs` are those of its first ones."""
        own = slice(len(pairs), int(memory.row_count[place]))
        parts = [it[place, own] for it in (memory.row_kind, memory.row_status, memory.row_dof)]
        key = b"".join(part.tobytes() for part in parts)
        found = self._known.get(key)
        if found is None:
            if len(self._known) >= _MOST_KEPT:
                self._known.clear()
            rows = zip(*(part.tolist() for part in parts), strict=True)
            found = self._known[key] = tuple(
                (self._name(kind, number), _STATUS[status]) for kind, status, number in rows
            )
        return (*pairs, *found) if pairs else found

    def _name(self, kind: int, number: int) -> str:
        if kind in _TIES:
            return f"{_TIES[kind]} {number}"
        return f"{_JOINTS[kind]} of {self._space.labels[number][0]}"


def raise_problem(problem: int, space: TangentSpace, dof: int) -> None:
    """Raise `NotImplementedError` for what a kernel has found of a dof."""
    if problem == YIELDING_USER:
        raise NotImplementedError("compliant constraints have no exact derivatives")
    raise NotImplementedError(_PROBLEMS[problem].format(space.labels[dof][0]))
