"""Linearisation of a world's steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, cast

from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from carom.linearization import LinearizedStep
    from carom.world.world import World


class Linearizing:
    """Linearisation of a world's steps."""

    def linearize(
        self,
        controls: Sequence[str] = ("torques",),
        *,
        parameters: Sequence[str] = (),
        steps: int = 1,
        method: str = "exact",
        smoothing: float = 0.0,
        outputs: Callable[[World], ArrayLike] | None = None,
    ) -> LinearizedStep:
        """What the next steps would do to small changes of state, controls and parameters.

        The world does not change. The derivatives are those of what a step computes, by the implicit function
        theorem over the rows of the solver (motors, limits, friction of joints, actuators) that hold at its
        end, as if its sweeps had converged: docs/solver.md says more. Applied forces and torques, which a
        world forgets after a step, act in all of these steps; so do changes of controls.

        Args:
            controls: Kinds of controls, or full names of some: "torques" (of all dofs of joints),
                "target_positions" and "target_velocities" (of motors), "actuators".
            parameters: Likewise: "masses" (centres and moments of inertia stay), "inertias" (principal
                moments), "inertial_parameters" (ten of each link), "friction" (lateral, of links),
                "joint_friction", "stiffness", "damping", "armature", "motor_position_gains",
                "motor_velocity_gains", "motor_forces", "actuator_gains", "actuator_biases".
            steps: Number of steps.
            method: "exact", or "differences" for central differences of the steps themselves, of all that can
                be in a world.
            smoothing: Softness of rows that hold, relative to their own inverse mass: 0.1 lets them yield by
                a tenth. Only with "exact".
            outputs: A function that returns numbers, such as readings of sensors, of a world after the steps;
                for `C` and `D`, which are found by central differences.

        Returns:
            The matrices, and what their rows and columns are.

        Raises:
            ValueError: An argument has a value that it cannot have; there is no such control or parameter.
            NotImplementedError: Something in these steps has no exact derivatives; it is named.
            carom.errors.SimulationError: A velocity is not finite.
        """
        from carom.linearization.linearized_step import linearize

        world = cast("World", self)
        return linearize(world, controls, parameters, steps, method, smoothing, outputs)
