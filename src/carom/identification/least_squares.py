"""Levenberg and Marquardt's method with lower bounds, and what data say about combinations of parameters."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from carom.checks import Array
from carom.identification.unknowns import Unknowns

_ITERATIONS = 100
# Gain of a step, in squares of standard deviations, that is not worth another.
_ENOUGH = 1e-8
_MAX_DAMPING = 1e6
_REDUNDANT = 1e-9
# How far towards the bodies that cannot be a step may go.
_SHARE_OF_ROOM = 0.9
# Weight of the distance of inertia from the start, as if it were known to within a factor of e: next to none.
_PULL = 0.5
# Its weight where all directions have an effect anyway: it only keeps inertia physical.
_GUARD = 1e-6
# Eigenvalues of JᵀJ below this share of the greatest are rounding errors.
_NOISE = 1e-13
# Effects of parameters below this share of the greatest do not count.
_FAINT = 1e-7


class Normal(NamedTuple):
    """A quadratic model of a cost, half the sum of weighted squares.

    Attributes:
        cost: The cost.
        gradient: By p, (n,).
        matrix: JᵀJ, (n, n).
        follow: What happens to values that are eliminated where p changes: called before the next model is
            asked for, with the change of p.
    """

    cost: float
    gradient: Array
    matrix: Array
    follow: Callable[[Array], None]


def minimise(
    model: Callable[[Array], Normal], unknowns: Unknowns, p: Array, *, drifts: bool
) -> tuple[Array, Normal]:
    """Minimise a cost, and with it a little of the distance of inertia from the start.

    For torques the cost is quadratic, and the distance is convex: there is one minimum.

    Args:
        model: The cost at some values p, and its derivatives. If a model was worse than the one before,
            `follow` of the latter is called again with a smaller change.
        unknowns: Names, scales and bounds.
        p: Values at which to start.
        drifts: Whether some directions may have no effect, so that inertia has to be kept in place there.

    Returns:
        The values at the minimum, and the model there.
    """
    weight = _PULL if drifts else _GUARD
    now, far = model(p), unknowns.distance(p)
    damping = 1e-8
    for _ in range(_ITERATIONS):
        gradient, matrix = now.gradient + weight * far[1], now.matrix + weight * far[2]
        free = (p > unknowns.lower) | (gradient < 0.0)
        of_free = gradient[free], matrix[np.ix_(free, free)]
        step = np.zeros(len(p))
        step[free] = _step(*of_free, damping)
        # What could be gained without damping, if the cost were quadratic.
        left = -0.5 * of_free[0] @ _step(*of_free, 0.0)
        tried = np.maximum(p + step * min(1.0, _SHARE_OF_ROOM * unknowns.room(p, step)), unknowns.lower)
        now.follow(tried - p)
        other, farther = model(tried), unknowns.distance(tried)
        gained = now.cost - other.cost + weight * (far[0] - farther[0])
        if gained >= 0.0:
            p, now, far = tried, other, farther
            damping = max(damping * 0.03, 1e-16)
            if max(gained, left) <= _ENOUGH:
                break
        else:
            now.follow(np.zeros(len(p)))
            if left <= _ENOUGH or damping > _MAX_DAMPING:
                now = model(p)
                break
            damping = max(damping * 30.0, 1e-10)
    return p, now


def _step(gradient: Array, matrix: Array, damping: float) -> Array:
    """The step of a quadratic model, damped as Marquardt did; 0 where nothing has an effect."""
    diagonal = np.diag(matrix)
    sizes = np.where(diagonal > 0.0, 1.0 / np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0)), 0.0)
    values, vectors = np.linalg.eigh(matrix * np.outer(sizes, sizes))
    known = values > _NOISE * max(values.max(initial=0.0), 1e-300)
    along = vectors[:, known].T @ (sizes * gradient)
    return -sizes * (vectors[:, known] @ (along / (values[known] + damping)))


class Combinations(NamedTuple):
    """Combinations of parameters that data determine.

    Attributes:
        factors: Of the parameters in each, (k, n): 1 for its first.
        covariance: Of the combinations, (k, k).
        rows: Which parameters have the factor 1.
    """

    factors: Array
    covariance: Array
    rows: list[int]


def combinations(matrix: Array, scale: Array) -> Combinations:
    """What can be told apart, from JᵀJ of residuals of unit variance.

    A parameter whose effect is a sum of those of parameters before it stands with these: its factor in their
    combinations says how. The last parameters are the first to be chosen, for those of the last
    links of an arm are usually determined by themselves.

    Args:
        matrix: JᵀJ, (n, n).
        scale: Sizes of the parameters: effects are compared at these.
    """
    scaled = matrix * np.outer(scale, scale)
    whole = max(np.diag(scaled).max(initial=0.0), 1e-300)
    chosen: list[int] = []
    for place in reversed(range(len(scale))):
        if not scaled[place, place] > _FAINT**2 * whole:
            continue
        if chosen:
            own = scaled[np.ix_(chosen, chosen)]
            sizes = 1.0 / np.sqrt(np.diag(own))
            effect = sizes * scaled[chosen, place]
            part = np.linalg.solve(own * np.outer(sizes, sizes), effect)
            if scaled[place, place] - effect @ part <= _REDUNDANT * scaled[place, place]:
                continue
        chosen.append(place)
    rows = sorted(chosen)
    size = 1.0 / np.sqrt(np.diag(scaled)[rows])
    inverse = np.linalg.inv(scaled[np.ix_(rows, rows)] * np.outer(size, size)) * np.outer(size, size)
    factors = inverse @ scaled[rows]
    factors[:, rows] = np.eye(len(rows))
    factors = np.where(np.abs(factors) > 1e-5, factors, 0.0)
    return Combinations(
        factors * np.outer(scale[rows], 1.0 / scale), inverse * np.outer(scale[rows], scale[rows]), rows
    )
