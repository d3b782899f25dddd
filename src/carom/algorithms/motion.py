"""Inverse dynamics, prepared for many calls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.ask import Ask, asking
from carom.layouts.codes import BASE_POSITIONS
from carom.layouts.mechanism import POSE
from carom.native.kernels import motion_kernel
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, array_view, numbers_of

if TYPE_CHECKING:
    from carom.algorithms.mechanism import Mechanism


def forces_of_motion(mechanism: Mechanism, *, as_pybullet: bool = False) -> Ask:
    """A function for the generalized forces of a motion of a mechanism.

    Args:
        mechanism: The mechanism, of at least one dof; its output holds the answer.
        as_pybullet: Gravity at a free base has the wrong direction that it has in PyBullet, see
            `turned_back_in_opposite_order`; and positions of spherical joints are roll, pitch and yaw.

    Returns:
        A function of four arguments: gravity [m/s²], in world axes, or in axes of the base if that is fixed;
        joint positions, for a free base after its position (3) and quaternion (4); joint rates, for a free
        base after its angular (3) and linear (3) velocity in its own axes; and the derivatives of these
        rates. It returns the joint forces, for a free base after the force (3) and torque (3) on it in its
        own axes. It raises `ValueError` if a number is not finite, a sequence has the wrong length, the
        quaternion is zero, or the forces overflow; `TypeError` for an argument that is not a sequence; and
        `struct.error` for an item that is not a number.
    """
    positions = mechanism.joint_dofs if as_pybullet else mechanism.coordinates
    counts = (
        int(POSE),
        positions + (BASE_POSITIONS if mechanism.free else 0),
        mechanism.dofs,
        mechanism.dofs,
    )
    numbers: np.ndarray = np.zeros(sum(counts), dtype=NUMPY_REAL)
    launch = Launch(motion_kernel, 1, [*mechanism.structs, array_view(numbers), int(as_pybullet)])
    output = numbers_of(mechanism.arrays["output"])
    return asking(counts, numbers_of(numbers), launch.brief_function, output, mechanism.dofs)
