"""How contacts of MuJoCo's files yield in a step, with derivatives.

The laws are those of `kernels.dynamics.contact_compliance`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep

_LEAST = 1e-15
_MIN_IMPEDANCE, _MAX_IMPEDANCE = 0.0001, 0.9999


@dataclass(frozen=True, slots=True)
class Compliance:
    """What the rows of a contact that yields have instead of a rigid one's.

    Their velocities after the step, plus softness times impulse, are those before it less what is damped and,
    along the normal, less what pulls the bodies apart.

    Attributes:
        damping, lateral_damping: Along the normal and sideways [1/s].
        pull_slope: By how much the pull [m/s²] grows with the distance [1/s²].
        softness, lateral_softness: Velocity per impulse [1/kg].
        softness_slope, lateral_slope: Their derivatives by the distance [1/(kg m)].
        by_friction, lateral_by_friction: Their derivatives by the coefficient of lateral friction [1/kg].
    """

    damping: float
    lateral_damping: float
    pull_slope: float
    softness: float
    softness_slope: float
    by_friction: float
    lateral_softness: float
    lateral_slope: float
    lateral_by_friction: float


def may_yield(taken: TakenStep, a: int, b: int) -> bool:
    """Whether contacts of two links yield as those of MuJoCo's files."""
    shapes, links = taken.shapes, [a, b]
    if shapes["link_impedance"][links, 1].max() <= 0.0 or shapes["link_stiffness"][links].max() >= 0.0:
        return False
    return bool(shapes["link_restitution"][a] * shapes["link_restitution"][b] <= 0.0)


def pair_of_links(taken: TakenStep, a: int, b: int) -> int | None:
    """The row of two links whose contacts are as a pair of the file states them; None for others."""
    shapes = taken.shapes
    if not may_yield(taken, a, b):
        return None
    found = (
        (shapes["filter_link_a"] == min(a, b))
        & (shapes["filter_link_b"] == max(a, b))
        & (shapes["filter_impedance"][:, 1] > 0.0)
    )
    rows = np.flatnonzero(found)
    return int(rows[0]) if len(rows) else None


def compliance_of(
    taken: TakenStep, links: tuple[int, int], friction: tuple[float, float, float], distance: float
) -> Compliance | None:
    """How a contact of two links yields at a distance [m]; None if it is rigid or has springs of links.

    `friction` has the coefficients of lateral, rolling and spinning friction.
    """
    shapes = taken.shapes
    a, b = links
    if not may_yield(taken, a, b):
        return None
    impedances = shapes["link_impedance"][[a, b]]
    share = _weight_of_first(taken, a, b)
    reference = _mixed_reference(taken, a, b, share)
    impedance = impedances[0] * share + impedances[1] * (1.0 - share)
    inverse_mass = float(impedances[0][3] + impedances[1][3])
    mixing = shapes["link_mixing"][[a, b]]
    margin, lateral = float(mixing[:, 1].sum()), reference
    row = pair_of_links(taken, a, b)
    if row is not None:
        reference, impedance = shapes["filter_reference"][row], shapes["filter_impedance"][row]
        margin, lateral = float(impedance[3]), shapes["filter_lateral"][row]
        lateral = lateral if lateral[:2].any() else reference
    error = distance - margin
    d, slope = _impedance_at(reference, impedance, error)
    stiffness, damping = _spring_and_damper(taken.time_step, reference, impedance)
    pyramids = float(mixing[:, 2].max())
    normal, sideways = _shares(pyramids, friction)
    softness, falling = inverse_mass * (1.0 - d) / d, -inverse_mass * slope / (d * d)
    return Compliance(
        damping=damping,
        lateral_damping=_spring_and_damper(taken.time_step, lateral, impedance)[1],
        pull_slope=stiffness * (d + slope * error),
        softness=softness * normal[0],
        softness_slope=falling * normal[0],
        by_friction=softness * normal[1],
        lateral_softness=softness * sideways[0],
        lateral_slope=falling * sideways[0],
        lateral_by_friction=softness * sideways[1],
    )


def _weight_of_first(taken: TakenStep, a: int, b: int) -> float:
    shapes = taken.shapes
    for link, weight in ((b, 1.0), (a, 0.0)):
        if shapes["link_impedance"][link][1] <= 0.0:
            return weight
    ranks = shapes["link_friction_rank"][[a, b]]
    if ranks[0] != ranks[1]:
        return float(ranks[0] > ranks[1])
    own, other = shapes["link_mixing"][[a, b], 0].tolist()
    if min(own, other) >= _LEAST:
        return own / (own + other)
    return 0.5 if max(own, other) < _LEAST else float(own >= _LEAST)


def _mixed_reference(taken: TakenStep, a: int, b: int, share: float) -> np.ndarray:
    own, other = taken.shapes["link_reference"][[a, b]]
    if share in (0.0, 1.0):
        return own if share else other
    mixed = own * share + other * (1.0 - share)
    if min(own[0], other[0]) <= 0.0:
        mixed[:2] = np.minimum(own, other)[:2]
    return mixed


def _impedance_at(reference: np.ndarray, impedance: np.ndarray, error: float) -> tuple[float, float]:
    """Impedance at an error, and its derivative by that."""
    first, last = np.clip(impedance[:2], _MIN_IMPEDANCE, _MAX_IMPEDANCE).tolist()
    width, power = float(impedance[2]), float(reference[3])
    if width <= _LEAST:
        return 0.5 * (first + last), 0.0
    x = abs(error) / width
    if x >= 1.0:
        return last, 0.0
    y, rise = x, 1.0
    if power > 1.0:
        middle = float(np.clip(reference[2], _MIN_IMPEDANCE, _MAX_IMPEDANCE))
        if x <= middle:
            y, rise = middle * (x / middle) ** power, power * (x / middle) ** (power - 1.0)
        else:
            left = (1.0 - x) / (1.0 - middle)
            y, rise = 1.0 - (1.0 - middle) * left**power, power * left ** (power - 1.0)
    return first + y * (last - first), float(np.sign(error)) * rise * (last - first) / width


def _spring_and_damper(time_step: float, reference: np.ndarray, impedance: np.ndarray) -> tuple[float, float]:
    """Stiffness [1/s²] and damping [1/s] at an impedance of 1."""
    last = float(np.clip(impedance[1], _MIN_IMPEDANCE, _MAX_IMPEDANCE))
    first, second = float(reference[0]), float(reference[1])
    if first <= 0.0:
        return -first / (last * last), -second / last
    constant = max(first, 2.0 * time_step)
    return 1.0 / max(_LEAST, (last * constant * second) ** 2), 2.0 / (last * constant)


def _shares(
    pyramids: float, friction: tuple[float, float, float]
) -> tuple[tuple[float, float], tuple[float, float]]:
    """How much more than its impedance says a contact yields along its normal, and sideways.

    Each with the derivative by the lateral friction.
    """
    lateral, rolling, spinning = friction
    if pyramids <= 0.0:
        return (1.0, 0.0), (1.0, 0.0)
    square = lateral * lateral
    sideways = pyramids * (1.0 + square), pyramids * 2.0 * lateral
    if lateral <= 0.0:
        return (1.0, 0.0), sideways
    edges = 5.0 if rolling > 0.0 else (3.0 if spinning > 0.0 else 2.0)
    share = pyramids / edges
    return (share * square * (1.0 + square), share * 2.0 * lateral * (1.0 + 2.0 * square)), sideways
