"""Whether the derivatives of a step mean anything: what is left of its sweeps, redundant rows, switches."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.layouts.linearization import CONTACT_ROW, NEAR_MARGIN, SHAPE_KINDS
from carom.logger import Logger

if TYPE_CHECKING:
    from carom.linearization.step_memory import StepMemory
    from carom.scene.core.world_core import WorldCore

_logger = Logger("carom.linearization")

# Sweeps that still change a velocity by more than this have not settled [m/s or rad/s].
UNSETTLED = 1e-3
# A contact that is nearer than this to where it begins is at a switch [m], ...
_TOUCHES = NEAR_MARGIN
# ... as is an impulse of which no more than this share is left to its bound.
_NO_ROOM = 1e-6
# Rows with no more than this part in a null vector of the equations have no part in it.
_PART = 1e-6
_MOST_NAMED = 3


@dataclass(frozen=True, eq=False, slots=True)
class StepQuality:
    """What tells how far the derivatives of a step can be trusted.

    Attributes:
        residual: By how much the last sweep of the solver still changed a velocity [m/s or rad/s].
        redundant: Numbers of rows whose impulses the equations do not determine.
        distances: Of each row, how far it is from where it would change its status; see `LinearizedStep`.
        at_switch: Numbers of rows that are there.
        others: Names of what is there without a row.
        measured: Numbers of the rows of contacts that move as central differences say.
    """

    residual: float
    redundant: tuple[int, ...]
    distances: tuple[float, ...]
    at_switch: tuple[int, ...]
    others: tuple[str, ...]
    measured: tuple[int, ...]

    def names_at_switch(self, rows: Sequence[tuple[str, str]]) -> tuple[str, ...]:
        """Names of all that is at a switch, by names and status of the rows."""
        if not self.at_switch:
            return self.others
        own = tuple(rows[row][0] for row in self.at_switch)
        return own + tuple(it for it in self.others if it not in own)


class Qualities:
    """Qualities of the steps of some worlds, worked out for one world when it is asked for.

    Args:
        residuals: Of each world, the greatest squared change of a velocity in the last sweep, (m,).

    Attributes:
        residuals: The same without squares [m/s or rad/s].
        of_stages: By numbers of worlds, names of what is at a switch in earlier stages of the step.
    """

    def __init__(self, residuals: np.ndarray) -> None:
        # Nothing is left where the solver converges.
        self.residuals: Array = np.sqrt(residuals) if np.count_nonzero(residuals) else residuals
        self.of_stages: dict[int, tuple[str, ...]] = {}
        self._parts: list[_Part] = []
        self._known: dict[int, StepQuality] = {}

    def add(
        self,
        memory: StepMemory,
        first: int,
        count: int,
        redundant: dict[int, tuple[int, ...]],
        others: list[tuple[str, ...]],
    ) -> None:
        """Note what is in the first places of the memory, of worlds from `first` on.

        Args:
            memory: The memory of the linearisation.
            first: Number of the world in its first place.
            count: Number of places.
            redundant: Numbers of redundant rows by place.
            others: Of each place, names of what is at a switch without a row.
        """
        rows: list[int] = memory.row_count[:count].tolist()
        most = max(rows, default=0)
        kinds, away = memory.row_kind[:count, :most].copy(), memory.row_switch[:count, :most].copy()
        measured: dict[int, tuple[int, ...]] = {}
        known = memory.measured[:count] >= 0
        if np.count_nonzero(known):
            places, contacts = np.nonzero(known)
            for place in np.unique(places).tolist():
                own = memory.row_dof[place, :most] // SHAPE_KINDS**2
                moved = (kinds[place] == CONTACT_ROW) & np.isin(own, contacts[places == place])
                measured[place] = tuple(np.flatnonzero(moved[: rows[place]]).tolist())
        self._parts.append(_Part(first, rows, kinds, away, dict(redundant), measured, others))
        self._known.clear()

    def __getitem__(self, world: int) -> StepQuality:
        found = self._known.get(world)
        if found is None:
            found = self._known[world] = self._of(world)
        return found

    def _of(self, world: int) -> StepQuality:
        part = next(it for it in reversed(self._parts) if it.first <= world)
        place = world - part.first
        count = part.rows[place]
        others = (*part.others[place], *self.of_stages.get(world, ()))
        distances: list[float] = []
        at_switch: list[int] = []
        # Most steps have few rows, of which lists take less time than arrays.
        kinds: list[int] = part.kinds[place, :count].tolist()
        for row, away in enumerate(part.away[place, :count].tolist()):
            if away >= 0.0:
                distances.append(away)
                if away <= (_TOUCHES if kinds[row] == CONTACT_ROW else _NO_ROOM):
                    at_switch.append(row)
            else:
                # A bound that is infinite, here NaN, is never reached.
                distances.append(math.nan if away < 0.0 else math.inf)
        return StepQuality(
            residual=float(self.residuals[world]),
            redundant=part.redundant.get(place, ()),
            distances=tuple(distances),
            at_switch=tuple(at_switch),
            others=tuple(dict.fromkeys(others)) if others else (),
            measured=part.measured.get(place, ()),
        )


class _Part(NamedTuple):
    """Worlds that were linearised together: the first of them, and what was noted in their places."""

    first: int
    rows: list[int]
    kinds: np.ndarray
    away: np.ndarray
    redundant: dict[int, tuple[int, ...]]
    measured: dict[int, tuple[int, ...]]
    others: list[tuple[str, ...]]


def redundant_rows(system: np.ndarray, share: float) -> tuple[int, ...]:
    """Numbers of rows of singular equations (r, r) that have a part in a null vector.

    Args:
        system: The equations.
        share: Singular values below this share of the greatest are 0.
    """
    _, values, across = np.linalg.svd(system)
    null = across[values <= share * values[0]]
    return tuple(np.flatnonzero(np.abs(null).max(axis=0, initial=0.0) > _PART).tolist())


def warn_of(world: WorldCore, qualities: Sequence[StepQuality], rows: Sequence[tuple[str, str]]) -> None:
    """Warn, once for a world, of derivatives that mean little.

    Args:
        world: The world.
        qualities: Of the steps.
        rows: Names and status of the rows of the last step.
    """
    if StepQuality in world.kept_linearization:
        return
    worst = max((it.residual for it in qualities), default=0.0)
    text = ""
    if worst > UNSETTLED:
        text = (
            f"the sweeps of the solver did not settle (the last one changed a velocity by {worst:.2g}), and "
            "derivatives are those of the step to which they converge: linearize(tight=True) takes that step"
        )
        redundant = [rows[row][0] for row in qualities[-1].redundant]
        if redundant:
            text += f"; rows that may contradict each other: {_listed(redundant)}"
    elif qualities and (near := qualities[-1].names_at_switch(rows)):
        text = f"at a switch, where derivatives are those of one side: {_listed(near)}"
    if text:
        world.kept_linearization[StepQuality] = True
        _logger.warning("a step is linearised where that means little: %s", text)


def tell_of_differences(world: WorldCore, problem: NotImplementedError) -> None:
    """Say, once for a world, that its derivatives are central differences, and why."""
    if NotImplementedError not in world.kept_linearization:
        world.kept_linearization[NotImplementedError] = True
        _logger.warning("derivatives are central differences of steps, not exact ones: %s", problem)


def _listed(names: Sequence[str]) -> str:
    more = len(names) - _MOST_NAMED
    return ", ".join(names[:_MOST_NAMED]) + (f" and {more} more" if more > 0 else "")
