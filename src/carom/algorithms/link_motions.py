"""Velocities and accelerations of link frames, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import LinkMotionDerivatives, LinkMotions, link_derivatives_of, link_motions_of
from carom.algorithms.sweeps import link_numbers, sweeps_of
from carom.layouts.mechanism import LINK_MOTION
from carom.native.gates import alone
from carom.native.kernels import link_derivatives_kernel, link_motions_kernel

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray


@alone("world.call_lock")
def link_motions(
    body: BodyCore,
    positions: Numbers,
    velocities: Numbers,
    accelerations: Numbers,
    links: Sequence[int] | None = None,
) -> LinkMotions:
    """Velocities and accelerations of link frames, in world axes.

    Accelerations are derivatives of velocities; gravity is not part of them.

    Args:
        body: The body.
        positions: As in `inverse_dynamics_derivatives`.
        velocities: Likewise.
        accelerations: Likewise.
        links: Indices of the k links; -1 is the base. All but the base by default.

    Returns:
        The motions of the origins of the link frames.

    Raises:
        ValueError: A sequence has the wrong length, a number is not finite, or the motions overflow.
        IndexError: There is no such link.
    """
    chosen, sweeps = link_numbers(body, links), sweeps_of(body)
    answer = sweeps.ask(
        *(link_motions_kernel, int(LINK_MOTION) * sweeps.links, sweeps.links),
        positions=positions,
        velocities=velocities,
        changes=accelerations,
    )
    return link_motions_of(answer, chosen)


@alone("world.call_lock")
def link_motion_derivatives(
    body: BodyCore, link: int, positions: Numbers, velocities: Numbers, accelerations: Numbers
) -> LinkMotionDerivatives:
    """Derivatives of velocity and acceleration of a link frame's origin, in world axes.

    Changes of positions are those of `inverse_dynamics_derivatives`; arguments and errors are those of
    `link_motions`.
    """
    link_numbers(body, [link])
    sweeps = sweeps_of(body)
    answer = sweeps.ask(
        *(link_derivatives_kernel, 4 * 6 * sweeps.dofs, 1 + link),
        positions=positions,
        velocities=velocities,
        changes=accelerations,
    )
    return link_derivatives_of(answer, sweeps.dofs)
