"""The linear-quadratic regulator about a pose of a world."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array
from carom.controllers.riccati import lqr_gains
from carom.controllers.state_space import Controls, StateSpace, WorldState, cost_matrix

if TYPE_CHECKING:
    from carom.linearization import LinearizedStep
    from carom.world.world import World


class LQR:
    """Linear-quadratic regulator: holds a world near the state in which the regulator was made.

    That state should be an equilibrium under the controls which are set at that time: forces against gravity
    are set before. The regulator adds -K x to them. The small change x of the state is as in
    `LinearizedStep`, so free bases and spherical joints have rotation vectors.

    Attributes:
        K: Gains, (nu, nx).
        P: The cost of all steps to come is xᵀ P x, (nx, nx).
        step: The linearisation, with names of states and controls.
        goal: The state it was made in.
        controls: The controls at that time, (nu,).

    Example:
        >>> force = f"{cartpole.name}.slider_to_cart.torque"
        >>> regulator = LQR(world, [force], state_cost=1.0, control_cost=0.01)
        >>> for _ in range(240):
        ...     regulator.apply()
        ...     world.step()
    """

    def __init__(
        self,
        world: World,
        controls: Sequence[str] = ("torques",),
        *,
        state_cost: ArrayLike,
        control_cost: ArrayLike,
        discount: float = 1.0,
        smoothing: float = 0.0,
    ) -> None:
        """Linearise the next step of a world, and solve the discrete Riccati equation.

        Args:
            world: The world.
            controls: As in `World.linearize`.
            state_cost: Q: a number, (nx,) for its diagonal, or (nx, nx).
            control_cost: R, likewise for the nu controls; its eigenvalues are positive.
            discount: A cost counts so many times that of the step before it. Less than 1 is for states with
                motions that can neither be controlled nor decay, such as where feet stand; unstable motions
                that grow less than 1/√discount in a step need not be stabilised then.
            smoothing: As in `World.linearize`.

        Raises:
            ValueError: An argument has a value that it cannot have, or there is no stabilising solution.
            NotImplementedError: The step has no exact derivatives.
        """
        if not 0.0 < discount <= 1.0:
            raise ValueError(f"discount must be above 0 and at most 1, not {discount}")
        self._world = world
        self._space = StateSpace(world)
        self._ports = Controls(world, controls)
        self.step: LinearizedStep = world.linearize(controls, smoothing=smoothing)
        q = cost_matrix(state_cost, self._space.size, "state_cost")
        r = cost_matrix(control_cost, len(self._ports.names), "control_cost")
        if np.linalg.eigvalsh(r)[0] <= 0.0:
            raise ValueError("control_cost must have positive eigenvalues")
        scale = np.sqrt(discount)
        self.K: Array
        self.P: Array
        self.K, self.P = lqr_gains(scale * self.step.A, scale * self.step.B, q, r)
        self.goal: WorldState = self._space.state_of(world)
        self.controls: Array = self._ports.read(world)

    @property
    def eigenvalues(self) -> Array:
        """Absolute values of the eigenvalues of A - B K, the largest first, (nx,)."""
        return np.sort(np.abs(np.linalg.eigvals(self.step.A - self.step.B @ self.K)))[::-1]

    def difference(self, world: World | None = None) -> Array:
        """The change x of the state since the regulator was made, (nx,).

        Args:
            world: A copy of the world; the world itself by default.
        """
        return self._space.difference(self._space.state_of(world or self._world), self.goal)

    def compute(self, world: World | None = None) -> Array:
        """The controls (nu,) for the present state; the argument is that of `difference`."""
        return self.controls - self.K @ self.difference(world)

    def apply(self, world: World | None = None) -> Array:
        """Set the controls for the next step, and return them; the argument is that of `difference`."""
        values = self.compute(world)
        self._ports.apply(world or self._world, values)
        return values
