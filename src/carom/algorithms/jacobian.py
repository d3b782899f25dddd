"""Jacobians of points on links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mechanism import mechanism_of
from carom.checks import Array
from carom.native.gates import gated
from carom.native.kernel_builtins import Asker

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


def jacobian(
    body: Body,
    link: int,
    local_position: Numbers,
    positions: Numbers,
) -> tuple[Array, Array]:
    """Linear and angular Jacobian of a point on a link.

    Args:
        body: The body.
        link: Index of the link; -1 is the base.
        local_position: The point: offset from the link frame's origin (for the base: from its centre of mass)
            along the axes of the inertial frame [m].
        positions: Joint positions in order, shape (n,).

    Returns:
        Matrices J with velocity = J rates, in axes of the base's inertial frame, each of shape (3, n); for a
        free body (3, 6 + n), the base first: angular, then linear.

    Raises:
        ValueError: The entries overflow.
    """
    ask = body.derived.get((jacobian, link)) or _made(body, link)
    found = ask(local_position, positions)
    return _checked(body, link, local_position, positions) if found is None else found


@gated("world.call_lock")
def _made(body: Body, link: int) -> Asker:
    ask = mechanism_of(body).jacobian_asker(body.world.call_lock, link)
    body.derived[jacobian, link] = ask
    return ask


@gated("world.call_lock")
def _checked(body: Body, link: int, local_position: Numbers, positions: Numbers) -> tuple[Array, Array]:
    mechanism = mechanism_of(body)
    linear, angular = mechanism.jacobian(link, local_position, positions)
    shape = (3, mechanism.dofs)
    return np.array(linear).reshape(shape), np.array(angular).reshape(shape)
