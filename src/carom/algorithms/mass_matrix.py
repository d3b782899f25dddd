"""The joint-space inertia matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mechanism import mechanism_of
from carom.algorithms.questions import asker_of
from carom.checks import Array
from carom.native.gates import gated
from carom.native.kernel_builtins import Asker

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def mass_matrix(body: BodyCore, positions: Sequence[float] | np.ndarray) -> Array:
    """Joint-space inertia matrix at the given joint positions, by the composite rigid body algorithm.

    The armature of joints, and of a free base, is part of it; that of tendons (`tendon_inertia`) is not, nor
    what damping and springs add in a time step.

    Args:
        body: The body.
        positions: Joint positions in order, shape (n,).

    Returns:
        Symmetric matrix, shape (n, n); for a free body (6 + n, 6 + n), the base first: angular, then linear
        velocity in its own axes.

    Raises:
        ValueError: There is another number of positions, or the entries overflow.
    """
    matrix = asker_of(body, _asker)(positions)
    return _checked(body, positions) if matrix is None else matrix


@gated("world.call_lock")
def _checked(body: BodyCore, positions: Sequence[float] | np.ndarray) -> Array:
    return mechanism_of(body).mass_matrix_array(positions)


def _asker(body: BodyCore) -> Asker:
    return mechanism_of(body).mass_matrix_asker(body.world.call_lock)
