"""Positions that follow from rates, as `kernels.dynamics.integration` finds them, and their derivatives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.linearization.turns import left_derivative, quaternion_of, rotation_of

if TYPE_CHECKING:
    from carom.linearization.tangent import TangentSpace


def positions_after(space: TangentSpace, positions: np.ndarray, rates: np.ndarray, time: float) -> np.ndarray:
    """Positions (m, coordinates) after a time [s] with constant rates (m, n): a new array."""
    changes = time * rates
    for _, dof, hand in space.planes:
        # Slides are along the axes after the turn; `moved` takes those before it.
        angle = hand * changes[:, dof]
        x, y = changes[:, dof + 1].copy(), changes[:, dof + 2].copy()
        changes[:, dof + 1] = np.cos(angle) * x - np.sin(angle) * y
        changes[:, dof + 2] = np.sin(angle) * x + np.cos(angle) * y
    return space.moved(positions, changes)


def changes_after(
    space: TangentSpace, rates: np.ndarray, before: np.ndarray, by_rates: np.ndarray, time: float
) -> np.ndarray:
    """Changes of positions after a time with constant rates.

    Args:
        space: The tangent space.
        rates: Rates (n,); those of a free base along the axes of the world.
        before: Changes of the positions before it, (n, columns).
        by_rates: Changes of the rates, (n, columns).
        time: The time [s].

    Returns:
        The changes, (n, columns), a new array.
    """
    after = before + time * by_rates
    for joints, sign in ((space.bases, 1.0), (space.balls, -1.0)):
        for _, dof in joints:
            own = slice(dof, dof + 3)
            # Changes of a spherical joint are along the axes of its link, which turn with it.
            turn = sign * time * rates[own]
            after[own] = rotation_of(quaternion_of(turn)) @ before[own]
            after[own] += time * left_derivative(turn) @ by_rates[own]
    for _, dof, hand in space.planes:
        turn, slide = time * rates[dof], time * rates[dof + 1 : dof + 3]
        cosine, sine = np.cos(hand * turn), np.sin(hand * turn)
        bent = np.outer(hand * np.array([-slide[1], slide[0]]), after[dof])
        back = np.array([[cosine, sine], [-sine, cosine]])
        own = slice(dof + 1, dof + 3)
        after[own] = back @ before[own] + bent + time * by_rates[own]
    return after


def own_rates(space: TangentSpace, position: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Rates (n,) with angular velocities of free bases along their own axes, at a position (coordinates,)."""
    found = rates.copy()
    for q, dof in space.bases:
        found[dof : dof + 3] = rotation_of(position[q + 3 : q + 7]).T @ rates[dof : dof + 3]
    return found


def world_rates(space: TangentSpace, position: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """The inverse of `own_rates`."""
    found = rates.copy()
    for q, dof in space.bases:
        found[dof : dof + 3] = rotation_of(position[q + 3 : q + 7]) @ rates[dof : dof + 3]
    return found
