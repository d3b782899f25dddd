"""Inverse dynamics, ready to be asked about again and again."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from struct import Struct
from typing import TYPE_CHECKING, Any

import numpy as np
import warp as wp

from carom.algorithms.tree.motion import POSE, motion_kernel
from carom.description.pose import Vector3
from carom.model.arrays import numbers_of
from carom.model.codes import BASE_POSITIONS
from carom.model.launch import Launch
from carom.model.real import NUMPY_REAL, real

if TYPE_CHECKING:
    from carom.algorithms.moving_tree import MovingTree

Numbers = Sequence[float] | np.ndarray

_DEVICE = "cpu"
_TYPE_CODE = np.dtype(NUMPY_REAL).char


class Motion:
    """Questions about the forces behind a motion of a tree, and the memory for one.

    Args:
        tree: The tree; its output holds the answer.
        opposite_order: Gravity at a free base has the wrong direction that PyBullet gives it, see
            `turned_back_in_opposite_order`.
    """

    __slots__ = (
        "_answer",
        "_arriving",
        "_find",
        "_first",
        "_gravity",
        "_memory",
        "_pack",
        "_positions",
        "_rates",
        "_unpack",
    )

    def __init__(self, tree: MovingTree, *, opposite_order: bool = False) -> None:
        self._rates = tree.dofs
        self._positions = tree.coordinates + (BASE_POSITIONS if tree.free else 0)
        count = self._positions + 2 * self._rates
        numbers: np.ndarray = np.zeros(int(POSE) + count, dtype=NUMPY_REAL)
        question: Any = wp.array(numbers, dtype=real, device=_DEVICE, copy=False)
        self._memory = numbers_of(numbers).cast("B")
        self._first = int(POSE) * numbers.itemsize
        self._pack = Struct(f"{count}{_TYPE_CODE}").pack_into
        self._gravity: Vector3 | None = None
        self._find = Launch(
            motion_kernel, 1, [*tree.structs, question, int(opposite_order)], _DEVICE
        ).brief_function
        output = numbers_of(tree.arrays["output"])
        self._arriving = output[tree.dofs :]
        self._answer = output.cast("B")
        self._unpack = Struct(f"{tree.dofs}{_TYPE_CODE}").unpack_from

    def forces(
        self, positions: Numbers, rates: Numbers, accelerations: Numbers, gravity: Vector3
    ) -> tuple[float, ...]:
        """Generalized forces that cause a motion.

        Args:
            positions: Of the joints; of a free base position (3) and quaternion (4) before them.
            rates: Of the joints; of a free base angular (3) and linear (3) velocity along its own axes
                before them.
            accelerations: Their derivatives, the base's along its own axes.
            gravity: Along the axes of a base that is at rest, in world axes where it is free [m/s²]. Taken
                for the same as long as it is the same object.

        Returns:
            Forces of the joints; force (3) and torque (3) on a free base along its own axes before them.

        Raises:
            ValueError: Something given is not finite or does not fit the tree, the quaternion has no
                length, or the forces would not be finite.
            TypeError: Something given has no length.
            struct.error: Something given is not a number.
        """
        if not len(rates) == len(accelerations) == self._rates or len(positions) != self._positions:
            raise ValueError("the question does not fit the tree")
        if gravity is not self._gravity:
            Struct(f"3{_TYPE_CODE}").pack_into(self._memory, 0, *gravity)
            self._gravity = gravity
        self._pack(self._memory, self._first, *positions, *rates, *accelerations)
        self._find()
        if -inf < self._arriving[0] < inf:
            return self._unpack(self._answer)
        raise ValueError("the forces are not finite")
