"""Trajectory optimisation by iLQR, differential dynamic programming without second derivatives of steps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, finite
from carom.controllers.box_qp import solve_box_qp
from carom.controllers.state_space import Controls, StateSpace, WorldState, cost_matrix
from carom.errors import SimulationError
from carom.linearization.stepping import Copies

if TYPE_CHECKING:
    from carom.world.world import World

# Shares of the computed change of controls that are tried, all at once.
_SHARES = 10.0 ** np.linspace(0.0, -3.0, 11)
# Regularisation of Tassa et al. (2012): least value, factor, largest value.
_LEAST, _FACTOR, _LARGEST = 1e-6, 1.6, 1e10
# A share of this or more is as good as the whole change.
_SHORT = 0.3
# Least improvement, as a share of that of the quadratic model.
_ACCEPTED = 1e-4


class Plan(NamedTuple):
    """Controls for T intervals, and feedback about the states that they lead to.

    Attributes:
        controls: (T, nu).
        states: T + 1 states, the first one that of the world.
        gains: Feedback K: controls are `controls` + K x for a small change x of the state, (T, nu, nx).
        cost: Cost of the plan.
        costs: Cost after each iteration, the first one that of the guess.
        converged: The last improvement was less than the tolerance, or no improvement was found.
    """

    controls: Array
    states: list[WorldState]
    gains: Array
    cost: float
    costs: list[float]
    converged: bool


class ILQR:
    """iLQR with bounds of the controls: control-limited DDP (Tassa, Mansard and Todorov 2014).

    The cost is the sum of (eᵀ Q e + uᵀ R u) / 2 at the start of T intervals, and eᵀ Qf e / 2 after them. The
    error e is the difference of the state from the goal in the tangent space of `World.linearize`, which
    gives the derivatives; `Q` is `state_cost` and so on. The world itself does not move: rollouts are steps
    of copies, those of a line search at once. For receding-horizon control, call `solve` at each interval,
    with the controls of the last plan shifted by one.

    Example:
        >>> planner = ILQR(world, ["torques"], goal=goal, state_cost=0.01, control_cost=0.01,
        ...                final_cost=100.0, limits=(-2.0, 2.0), steps=4)
        >>> plan = planner.solve(np.zeros((100, 1)))
    """

    def __init__(
        self,
        world: World,
        controls: Sequence[str] = ("torques",),
        *,
        goal: WorldState,
        state_cost: ArrayLike,
        control_cost: ArrayLike,
        final_cost: ArrayLike,
        limits: tuple[ArrayLike, ArrayLike] = (-np.inf, np.inf),
        steps: int = 1,
        smoothing: float = 0.0,
    ) -> None:
        """Define a problem.

        Args:
            world: The world; a plan starts in its state at that time.
            controls: As in `World.linearize`.
            goal: The state that costs nothing: `state_of(world)` when it is there.
            state_cost: Q: a number, (nx,) for its diagonal, or (nx, nx).
            control_cost: R, likewise for the nu controls; its eigenvalues are positive.
            final_cost: Qf, as Q.
            limits: Lower and upper bounds of the controls, numbers or (nu,).
            steps: Steps of the world in an interval, in which controls are constant.
            smoothing: As in `World.linearize`.

        Raises:
            ValueError: An argument has a value that it cannot have.
        """
        if steps < 1:
            raise ValueError(f"steps must be at least 1, not {steps}")
        self._world, self._names, self._goal = world, list(controls), goal
        self._space, self._ports = StateSpace(world), Controls(world, controls)
        size, count = self._space.size, len(self._ports.names)
        self._q = cost_matrix(state_cost, size, "state_cost")
        self._final = cost_matrix(final_cost, size, "final_cost")
        self._r = cost_matrix(control_cost, count, "control_cost")
        self._lower, self._upper = (np.broadcast_to(np.asarray(bound, float), (count,)) for bound in limits)
        if not (self._lower <= self._upper).all():
            raise ValueError("the lower limits must not be above the upper ones")
        self._steps, self._smoothing = steps, smoothing

    def solve(self, controls: ArrayLike, *, iterations: int = 200, tolerance: float = 1e-6) -> Plan:
        """Improve a guess of the controls until the cost falls no more.

        Args:
            controls: The guess, (T, nu); clipped to the limits.
            iterations: Largest number of iterations.
            tolerance: Improvement of the cost at which to stop, as a share of it.

        Raises:
            ValueError: The guess has the wrong shape.
            NotImplementedError: A step has no exact derivatives.
            carom.errors.SimulationError: The guess leads to velocities that are not finite.
        """
        guess = finite(controls, "controls")
        if guess.ndim != 2 or guess.shape[1] != len(self._ports.names) or not len(guess):
            raise ValueError(f"controls must have shape (T, {len(self._ports.names)}), not {guess.shape}")
        guess = np.clip(guess, self._lower, self._upper)
        used, states, cost = self._rollouts(guess, None, None, None)
        first = [_at(it, 0) for it in states]
        plan = Plan(used[:, 0], first, self._no_gains(guess), float(cost[0]), [], False)
        costs, converged = [plan.cost], False
        regularisation, model = _LEAST, self._linearized(plan.controls)
        for _ in range(iterations):
            found = self._backward(plan, model, regularisation)
            if found is not None:
                changes, gains, expected = found
                plan = plan._replace(gains=gains)
                better = self._line_search(plan, changes, gains, expected)
                if better is not None:
                    better, share = better
                    improved = plan.cost - better.cost
                    plan = better
                    costs.append(plan.cost)
                    # A short step: the quadratic model reaches too far.
                    far = share < _SHORT
                    regularisation = max(_LEAST, regularisation * (_FACTOR if far else 1.0 / _FACTOR))
                    if not far and improved <= tolerance * max(abs(plan.cost), 1e-12):
                        converged = True
                        break
                    model = self._linearized(plan.controls)
                    continue
                if -expected[0] <= tolerance * max(abs(plan.cost), 1e-12):
                    converged = True
                    break
            regularisation *= _FACTOR**4
            if regularisation > _LARGEST:
                converged = found is not None
                break
        return plan._replace(costs=costs, converged=converged)

    def apply(self, plan: Plan, interval: int, world: World | None = None) -> Array:
        """Set the controls of a plan for the next step, with feedback about its states, and return them.

        Args:
            plan: The plan.
            interval: Number of the interval, from 0; the feedback is about the state at its start.
            world: A copy of the world; the world itself by default.
        """
        world = world or self._world
        change = self._space.difference(self._space.state_of(world), plan.states[interval])
        wanted = plan.controls[interval] + plan.gains[interval] @ change
        values = np.clip(wanted, self._lower, self._upper)
        self._ports.apply(world, values)
        return values

    def _no_gains(self, controls: np.ndarray) -> np.ndarray:
        return np.zeros((*controls.shape, self._space.size))

    def _linearized(self, controls: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """A and B of each interval."""
        world = self._world.copy()
        found = []
        for values in controls:
            self._ports.apply(world, values)
            step = world.linearize(self._names, steps=self._steps, smoothing=self._smoothing)
            found.append((step.A, step.B))
            for _ in range(self._steps):
                self._ports.apply(world, values)
                world.step()
        return found

    def _backward(
        self, plan: Plan, model: list[tuple[np.ndarray, np.ndarray]], regularisation: float
    ) -> tuple[np.ndarray, np.ndarray, tuple[float, float]] | None:
        """Changes (T, nu) and gains (T, nu, nx), and two coefficients of the change of cost that is expected.

        None if the quadratic model has no minimum.
        """
        changes, gains = np.zeros_like(plan.controls), self._no_gains(plan.controls)
        linear = quadratic = 0.0
        value_x, value_xx = self._error(plan.states[-1], self._final)
        damping = regularisation * np.eye(self._space.size)
        for t in reversed(range(len(changes))):
            (a, b), u = model[t], plan.controls[t]
            cost_x, cost_xx = self._error(plan.states[t], self._q)
            q_x, q_u = cost_x + a.T @ value_x, self._r @ u + b.T @ value_x
            q_xx, q_ux, q_uu = cost_xx + a.T @ value_xx @ a, b.T @ value_xx @ a, self._r + b.T @ value_xx @ b
            held_ux, held_uu = q_ux + b.T @ damping @ a, q_uu + b.T @ damping @ b
            try:
                change, free = solve_box_qp(held_uu, q_u, self._lower - u, self._upper - u)
            except np.linalg.LinAlgError:
                return None
            gain = np.zeros_like(q_ux)
            gain[free] = -np.linalg.solve(held_uu[np.ix_(free, free)], held_ux[free])
            changes[t], gains[t] = change, gain
            linear += float(change @ q_u)
            quadratic += float(0.5 * change @ q_uu @ change)
            value_x = q_x + gain.T @ (q_uu @ change + q_u) + q_ux.T @ change
            value_xx = q_xx + gain.T @ q_uu @ gain + gain.T @ q_ux + q_ux.T @ gain
            value_xx = 0.5 * (value_xx + value_xx.T)
        return changes, gains, (linear, quadratic)

    def _error(self, state: WorldState, cost: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gradient and Gauss-Newton Hessian of the cost of a state."""
        error = self._space.difference(state, self._goal)
        by_state = self._space.difference_derivative(state, self._goal)
        return by_state.T @ cost @ error, by_state.T @ cost @ by_state

    def _line_search(
        self, plan: Plan, changes: np.ndarray, gains: np.ndarray, expected: tuple[float, float]
    ) -> tuple[Plan, float] | None:
        """The best of the shares of a change, if it improves the cost enough, and the share."""
        try:
            used, states, costs = self._rollouts(plan.controls, changes, gains, plan.states)
        except SimulationError:
            return None
        best = int(np.argmin(costs))
        hoped = -(_SHARES[best] * expected[0] + _SHARES[best] ** 2 * expected[1])
        if not plan.cost - costs[best] > _ACCEPTED * max(hoped, 0.0):
            return None
        reached = [_at(it, best) for it in states]
        better = plan._replace(controls=used[:, best], states=reached, cost=float(costs[best]))
        return better, float(_SHARES[best])

    def _rollouts(
        self,
        controls: np.ndarray,
        changes: np.ndarray | None,
        gains: np.ndarray | None,
        about: list[WorldState] | None,
    ) -> tuple[np.ndarray, list[WorldState], np.ndarray]:
        """Controls (T, m, nu), T + 1 states and costs (m,) of m worlds, one for each share of the changes."""
        copies = Copies(self._world, 1 if changes is None else len(_SHARES))
        used = np.repeat(controls[:, None], copies.count, axis=1)
        states = [self._space.states_in(copies.engine.arrays.state.numpy)]
        costs = np.zeros(copies.count)
        for t in range(len(controls)):
            if changes is not None and gains is not None and about is not None:
                change = self._space.difference(states[t], about[t])
                wanted = controls[t] + _SHARES[:, None] * changes[t] + change @ gains[t].T
                used[t] = np.clip(wanted, self._lower, self._upper)
            costs += self._cost(states[t], self._q) + 0.5 * ((used[t] @ self._r) * used[t]).sum(axis=1)
            for _ in range(self._steps):
                self._ports.write(copies.engine.arrays.state.numpy, used[t])
                copies.step()
            states.append(self._space.states_in(copies.engine.arrays.state.numpy))
        return used, states, costs + self._cost(states[-1], self._final)

    def _cost(self, states: WorldState, cost: np.ndarray) -> np.ndarray:
        error = self._space.difference(states, self._goal)
        return 0.5 * ((error @ cost) * error).sum(axis=1)


def _at(states: WorldState, world: int) -> WorldState:
    return WorldState(*(array[world] for array in states))
