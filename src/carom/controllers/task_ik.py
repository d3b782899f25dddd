"""Differential inverse kinematics by tasks and limits: a quadratic program at each tick."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from carom.checks import Array, positive
from carom.controllers.configuration import Configuration
from carom.controllers.ik_limits import Limit
from carom.controllers.tasks import Task
from carom.errors import CaromError

# What DAQP calls an inequality that may be violated at a cost.
_SOFT = 8
# For DAQP, no bound.
_ENDLESS = 1e30
# Directions in which constraints change by less than this share of the most follow from others.
_DEPENDENT = 1e-9
# What constraints may lack that cannot be kept together [rad or m].
_CONTRADICTION = 1e-6


class NoSolutionError(CaromError):
    """The quadratic program of a tick has no solution."""


class TaskIK:
    """Finds velocities that serve tasks best and keep limits; a QP by DAQP, an active-set solver.

    The sum of the squares of costs times what is missing, cost (J dq - gain e), is least. Limits that cannot
    be kept together, as where a link is nearer to another than it may be, are kept as well as possible.

    Attributes:
        configuration: The configuration.
        tasks: The tasks; may be changed.
        limits: The limits; may be changed.
        constraints: Tasks that are kept exactly; may be changed.

    Example:
        >>> ik = TaskIK(Configuration(robot), [FrameTask(11, (0.5, 0.1, 0.4))])
        >>> velocities = ik.solve(1 / 240)
    """

    def __init__(
        self,
        configuration: Configuration,
        tasks: Sequence[Task],
        limits: Sequence[Limit] = (),
        *,
        constraints: Sequence[Task] = (),
        damping: float = 1e-6,
    ) -> None:
        """Put a problem together.

        Args:
            configuration: The configuration.
            tasks: The tasks.
            limits: The limits.
            constraints: Tasks that each tick keeps exactly, J dq = gain e, whatever their costs: joints that
                stay, `FreezeTask`, loops that are closed, `EqualityTask`, or any other.
            damping: Cost of the square of all changes; makes the solution unique.

        Raises:
            ImportError: The solver is not installed: `pip install 'carom[control]'`.
            ValueError: The damping is not positive.
        """
        try:
            import daqp
        except ImportError as problem:
            raise ImportError("task IK needs a QP solver: pip install 'carom[control]'") from problem
        self._solver: Any = daqp.solve
        self.configuration: Configuration = configuration
        self.tasks: list[Task] = list(tasks)
        self.limits: list[Limit] = list(limits)
        self.constraints: list[Task] = list(constraints)
        self._damping = float(positive(damping, "damping")) * np.eye(configuration.dofs)
        whole = np.full(configuration.dofs, _ENDLESS)
        self._endless = -whole, whole

    def solve(self, time_step: float) -> Array:
        """The velocities (n,) for a tick of `time_step` [s]; the configuration does not change.

        Raises:
            NoSolutionError: There is no solution.
        """
        count = self.configuration.dofs
        h, f = self._damping.copy(), np.zeros(count)
        for task in self.tasks:
            error, jacobian = task.rows(self.configuration)
            weighted = jacobian.T * (task.cost * task.cost)
            h += weighted @ jacobian
            f -= task.gain * (weighted @ error)
        lower, upper, g, rows = self._inequalities(time_step)
        kept, wanted = self._equalities()
        low = np.concatenate([lower, np.full(len(rows), -_ENDLESS), wanted])
        high = np.concatenate([upper, rows, wanted])
        sense = np.zeros(len(low), dtype=np.intc)
        both = np.concatenate([g, kept])
        change, _, flag, _ = self._solver(h, f, both, high, low, sense)
        if flag < 0 and len(rows):
            sense[count : count + len(rows)] = _SOFT
            change, _, flag, _ = self._solver(h, f, both, high, low, sense)
        if flag < 0:
            raise NoSolutionError(
                f"the quadratic program of inverse kinematics has no solution ({flag}): constraints "
                "and limits contradict each other"
            )
        # Not even by rounding beyond the bounds.
        return np.clip(change, lower, upper) / time_step

    def tick(self, time_step: float) -> Array:
        """Solve, move the configuration with the velocities for `time_step` [s], and return them, (n,)."""
        velocities = self.solve(time_step)
        self.configuration.integrate(velocities, time_step)
        return velocities

    def _equalities(self) -> tuple[np.ndarray, np.ndarray]:
        """Rows of the constraints, and what they are to be."""
        found = [(task.rows(self.configuration), task.gain) for task in self.constraints]
        if not found:
            return np.zeros((0, self.configuration.dofs)), np.zeros(0)
        matrix = np.concatenate([rows.jacobian for rows, _ in found])
        wanted = np.concatenate([gain * rows.error for rows, gain in found])
        # Rows that follow from others, as most of a loop's in a plane do, are left out.
        sides, sizes, directions = np.linalg.svd(matrix, full_matrices=False)
        free = sizes > _DEPENDENT * max(sizes.max(initial=0.0), 1.0)
        along = (sides.T @ wanted)[free]
        missing = wanted - sides[:, free] @ along
        if np.abs(missing).max(initial=0.0) > _CONTRADICTION:
            raise NoSolutionError(
                f"constraints of inverse kinematics contradict each other, by {np.abs(missing).max():.3g}"
            )
        return directions[free], along / sizes[free]

    def _inequalities(self, time_step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Bounds of the changes, and rows G and h."""
        count = self.configuration.dofs
        lower, upper = self._endless
        matrices, bounds = [np.zeros((0, count))], [np.zeros(0)]
        for limit in self.limits:
            box = limit.bounds(self.configuration, time_step)
            if box is not None:
                # A bound beyond the opposite one, as of a joint outside of its limits, is moved there.
                tight = np.clip(box.lower, lower, upper)
                upper = np.clip(box.upper, lower, upper)
                lower = np.minimum(tight, upper)
            rows = limit.inequalities(self.configuration, time_step)
            if rows is not None:
                matrices.append(rows.g)
                bounds.append(rows.h)
        return lower, upper, np.concatenate(matrices), np.concatenate(bounds)
