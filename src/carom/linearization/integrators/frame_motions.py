"""Free bases that move by the origins of their frames, linearised: see `kernels.integrators.frames`.

With c from the origin of the frame to the centre of mass, before the step and after it, s = ω x (ω x c), the
accelerations a that kernels have linearised, and ω' and the velocity u to which a - s and all rows lead:

    v⁺ = u - ω' x c + ω' x c',  x⁺ = x - c + h (u - ω' x c) + c'
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.engine.parameters import COMPLIANT, OF_STEPS
from carom.linearization.inputs import INERTIAL
from carom.linearization.turns import cross, cross_matrix, quaternion_of, rotation_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from carom.engine.parameters import EngineParameters
    from carom.linearization.inputs import Input
    from carom.linearization.step_memory import StepMemory
    from carom.linearization.tangent import TangentSpace
    from carom.model.builder import WorldArrays


class Carried(NamedTuple):
    """What turning carries a base along.

    Attributes:
        dof: First dof of the base.
        arm: c, (3,) [m].
        omega: ω, (3,) [rad/s].
        acceleration: s, (3,) [m/s²].
        by_turn: Its derivative by a turn of the base, along the axes of the world, (3, 3).
        by_omega: That by ω.
    """

    dof: int
    arm: np.ndarray
    omega: np.ndarray
    acceleration: np.ndarray
    by_turn: np.ndarray
    by_omega: np.ndarray

    @classmethod
    def of(cls, dof: int, arm: np.ndarray, omega: np.ndarray) -> Carried:
        """Of a base at an instant."""
        spun, swung = cross_matrix(omega), cross_matrix(arm)
        return cls(
            dof, arm, omega, spun @ spun @ arm, -spun @ spun @ swung, -spun @ swung - cross_matrix(spun @ arm)
        )

    @property
    def turns(self) -> slice:
        """The dofs that turn the base."""
        return slice(self.dof, self.dof + 3)

    @property
    def shifts(self) -> slice:
        """The dofs that shift it."""
        return slice(self.dof + 3, self.dof + 6)

    def changes(self, dofs: int, columns: int) -> np.ndarray:
        """Changes of the acceleration by the state before the step, (3, columns); there are `dofs` dofs."""
        found = np.zeros((3, columns))
        found[:, self.turns] = self.by_turn
        found[:, dofs + self.dof : dofs + self.dof + 3] = self.by_omega
        return found


class FrameMotions:
    """The bases of a tangent space that are free and whose centre of mass is not at the origin of the frame.

    Args:
        space: The tangent space.
        arrays: Arrays of the worlds whose steps are linearised.
    """

    def __init__(self, space: TangentSpace, arrays: WorldArrays) -> None:
        self._space, self._arrays = space, arrays

    def _bases(self) -> list[tuple[int, int, np.ndarray]]:
        """First dof and row of positions of each, and c along the axes of its inertial frame."""
        arms: np.ndarray = self._arrays.model.numpy["link_com_from_pivot"]
        free = [body for body in self._space.bodies if not body.fixed_base]
        return [
            (dof, q, arms[body.first_link])
            for (q, dof), body in zip(self._space.bases, free, strict=True)
            if arms[body.first_link].any()
        ]

    def follow(self, parameters: EngineParameters) -> bool:
        """Whether there are any under these parameters."""
        by_frame = parameters.contact == COMPLIANT and parameters.integrator not in OF_STEPS
        return by_frame and bool(self._bases())

    def refuse(self, inputs: Sequence[Input]) -> None:
        """Refuse derivatives by parameters that move the centre of mass of such a base.

        Raises:
            NotImplementedError: There are such parameters.
        """
        arms = self._arrays.model.numpy["link_com_from_pivot"]
        free = [body for body in self._space.bodies if not body.fixed_base]
        for body in free:
            if arms[body.first_link].any() and any(
                it.kind == INERTIAL and it.row == body.first_link for it in inputs
            ):
                raise NotImplementedError(
                    f"inertial parameters of the base of {body.name!r} move its centre of mass in its frame, "
                    "by whose origin it moves with MuJoCo's integrators, so they have no exact derivatives: "
                    'leave them out, or use integrator="discrete"'
                )

    def at(self, position: np.ndarray, velocity: np.ndarray) -> list[Carried]:
        """What turning carries bases along at positions (coordinates,) and velocities of dofs (n,)."""
        return [
            Carried.of(dof, rotation_of(position[q + 3 : q + 7]) @ arm, velocity[dof : dof + 3])
            for dof, q, arm in self._bases()
        ]

    def shift(self, memory: StepMemory, place: int, position: np.ndarray, h: float) -> list[Carried]:
        """Turn velocities of a place that accelerations have led to into those that rows see.

        Args:
            memory: The memory.
            place: The place.
            position: Positions before the step, (coordinates,).
            h: Duration of the step [s].

        Returns:
            What turning carries along.
        """
        velocity = memory.velocity[place]
        found = self.at(position, velocity[0])
        for it in found:
            velocity[1:, it.shifts] -= h * it.acceleration
        return found

    def begin(self, memory: StepMemory, place: int, position: np.ndarray, h: float) -> None:
        """Correct velocities and forces of a place before rows are added; arguments as of `shift`."""
        force, effective = memory.force[place], memory.effective[place]
        for it in self.shift(memory, place, position, h):
            changes = it.changes(len(self._space), force.shape[2])
            force -= effective[:, it.shifts] @ changes

    def end(self, memory: StepMemory, place: int, position: np.ndarray, after: np.ndarray, h: float) -> None:
        """Correct the derivatives of a place, which are those of u and ω'; `after` has velocities, (n,)."""
        step, dofs = memory.step[place], len(self._space)
        for it in self.at(position, memory.velocity[place, 0]):
            spun = cross_matrix(after[it.turns])
            turn = rotation_of(quaternion_of(h * after[it.turns]))
            arm, arm_after = cross_matrix(it.arm), cross_matrix(turn @ it.arm)
            sped, rates = slice(dofs + it.dof + 3, dofs + it.dof + 6), slice(dofs + it.dof, dofs + it.dof + 3)
            by_turn = np.zeros((3, step.shape[1]))
            by_turn[:, it.turns] = -arm
            by_turn_after = -arm_after @ step[it.turns]
            origin = step[sped] + arm @ step[rates] - spun @ by_turn
            step[it.shifts] = h * origin - by_turn + by_turn_after
            step[it.shifts, it.shifts] += np.eye(3)
            step[sped] = origin - arm_after @ step[rates] + spun @ by_turn_after

    def undo_end(self, velocity: np.ndarray, position: np.ndarray, h: float) -> None:
        """Turn velocities after a step (rows,) into those that rows see, u.

        Args:
            velocity: The velocities, in the order of `World.velocity`, to change.
            position: Positions before the step, (coordinates,).
            h: Duration of the step [s].
        """
        own = velocity[self._space.dofs]
        for it in self.at(position, own):
            turned = rotation_of(quaternion_of(h * it.omega)) @ it.arm
            velocity[self._space.dofs[it.shifts]] -= cross(it.omega, turned - it.arm)

    def add_carried(
        self, position: np.ndarray, velocity: np.ndarray, ends: np.ndarray, by_state: np.ndarray, h: float
    ) -> None:
        """Add what turning carries along to the velocities (n,) after a stage, and to their derivatives.

        Args:
            position: Positions before the stage, (coordinates,).
            velocity: Velocities there, (n,), in world axes.
            ends: Velocities after it, to change.
            by_state: Derivatives of the state after it, to change.
            h: Duration of the step [s].
        """
        dofs = len(self._space)
        for it in self.at(position, velocity):
            ends[it.shifts] += h * it.acceleration
            sped = slice(dofs + it.dof + 3, dofs + it.dof + 6)
            by_state[sped] += h * it.changes(dofs, by_state.shape[1])

    @staticmethod
    def damping(it: Carried, wanted: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """How s changes with velocities that change by `wanted` (n,), and its changes by turns and by ω.

        Returns:
            The change (3,), and two matrices (3, 3).
        """
        kick = wanted[it.turns]
        spun, kicked, swung = cross_matrix(it.omega), cross_matrix(kick), cross_matrix(it.arm)
        both = kicked @ spun + spun @ kicked
        by_omega = -kicked @ swung - cross_matrix(cross(kick, it.arm))
        return both @ it.arm, -both @ swung, by_omega
