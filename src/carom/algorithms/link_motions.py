"""Velocities and accelerations of link frames, and their derivatives."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.answers import (
    LinkMotionDerivatives,
    LinkMotions,
    link_motions_of,
    motion_matrices,
    motions_of,
)
from carom.algorithms.questions import Question, sweep_question
from carom.algorithms.sweeps import Views, link_numbers
from carom.layouts.mechanism import LINK_MOTION
from carom.native.kernels import link_derivatives_kernel, link_motions_kernel

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray


def _motions(views: Views) -> Question:
    size, links = lambda of: int(LINK_MOTION) * of.links, lambda of: of.links
    return sweep_question(link_motions_kernel, size, views, links)


_MOTIONS = _motions(lambda answer, _: [motion[1:] for motion in motions_of(answer)])
_ALL_NUMBERS = _motions(lambda answer, _: [answer])


@cache
def _of_link(row: int) -> Question:
    return sweep_question(
        link_derivatives_kernel,
        lambda of: 4 * 6 * of.dofs,
        lambda answer, of: motion_matrices(answer, of.dofs),
        lambda _: row,
    )


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
    if links is None:
        return LinkMotions(*_MOTIONS(body, positions, velocities, accelerations))
    chosen = link_numbers(body, links)
    return link_motions_of(_ALL_NUMBERS(body, positions, velocities, accelerations), chosen)


def link_motion_derivatives(
    body: BodyCore, link: int, positions: Numbers, velocities: Numbers, accelerations: Numbers
) -> LinkMotionDerivatives:
    """Derivatives of velocity and acceleration of a link frame's origin, in world axes.

    Changes of positions are those of `inverse_dynamics_derivatives`; arguments and errors are those of
    `link_motions`.
    """
    link_numbers(body, [link])
    found = _of_link(1 + link)(body, positions, velocities, accelerations)
    return LinkMotionDerivatives(*found)
