"""How rows of the converged solver yield for their own inverse mass, by parameters of inertia.

Of a rigid contact's two rows of friction that is the mean of both, and they remember an impulse π:
x = v − R π, and λ = −x/R where they stick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.linearization import CONTACT_FRICTION, ROLLING_FRICTION, ROW_HOLDS, SHAPE_KINDS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from carom.linearization.step_memory import StepMemory

_DISCS = CONTACT_FRICTION, ROLLING_FRICTION


def add_softness(
    memory: StepMemory,
    place: int,
    contacts: Mapping[str, np.ndarray],
    mass_changes: Callable[[np.ndarray], np.ndarray],
    width: int,
) -> None:
    """Add to the rows of a place how their softness changes with inputs; all rows are there.

    Args:
        memory: The memory of the kernels.
        place: The place.
        contacts: The fields of the contacts of all worlds.
        mass_changes: Gives derivatives of M r by inputs, (n, inputs), for a constant r (n,).
        width: Number of states, behind which columns are those of inputs.
    """
    world, count = int(memory.world[place]), int(memory.row_count[place])
    kinds, impulses = memory.row_kind[place], memory.row_impulse[place]
    softness, side = memory.row_yield[place], memory.side[place, :, width:]

    def driven(row: int) -> np.ndarray:
        response = memory.inverse[place] @ memory.jacobian[place, row]
        return response @ mass_changes(response)

    row = 0
    while row < count:
        if softness[row] and kinds[row] in _DISCS:
            pair = slice(row, row + 2)
            softens = 0.5 * softness[row] * (driven(row) + driven(row + 1))
            contact = memory.row_dof[place, row] // SHAPE_KINDS**2
            pulls = np.zeros(2)
            if kinds[row] == CONTACT_FRICTION:
                memory_of = contacts["contact_anchor_b"][world, contact]
                axes = ("contact_direction1", "contact_direction2")
                pulls = np.array([memory_of @ contacts[name][world, contact] for name in axes])
            shares = memory.alpha[place, pair, pair] @ pulls
            if memory.row_status[place, row] == ROW_HOLDS:
                shares = shares - impulses[pair]
            side[pair] -= shares[:, None] * softens
            row += 2
            continue
        if softness[row]:
            side[row] += softness[row] * impulses[row] * driven(row)
        row += 1
