"""Results of rays, as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from carom.checks import Array

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class RayHits(NamedTuple):
    """Results of n rays, in many worlds with the world as first axis, (count, n).

    Attributes:
        bodies: Numbers of the bodies, -1 without a hit, (n,).
        links: Their links, -1 for the base and without a hit, (n,).
        fractions: Fraction along the ray: 0 at the start, 1 at the end and without a hit, (n,).
        positions: Points in world axes [m], (n, 3).
        normals: Unit normals there, (n, 3).
    """

    bodies: NDArray[np.int32]
    links: NDArray[np.int32]
    fractions: Array
    positions: Array
    normals: Array
