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
        as_pybullet: Gravity at a free base has the wrong direction that PyBullet gives it, see
            `turned_back_in_opposite_order`; and spherical joints have roll, pitch and yaw for positions.

    Returns:
        A function of gravity, along the axes of a base that is at rest, in world axes where it is free
        [m/s²]; positions of the joints, and of a free base position (3) and quaternion (4) before them; rates
        of the joints, and of a free base angular (3) and linear (3) velocity along its own axes before them;
        and the derivatives of the rates, the base's along its own axes. Its result are the forces of the
        joints, and force (3) and torque (3) on a free base along its own axes before them. It raises
        `ValueError` if something given is not finite, or not as long as it has to be, if the quaternion has
        no length, or the forces would not be finite; `TypeError` for what is no sequence; and `struct.error`
        for what is not a number.
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
