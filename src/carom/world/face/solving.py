"""The solver of a world: how far it goes."""

from __future__ import annotations

from typing import NamedTuple

from carom.checks import finite
from carom.engine.parameters import CONVERGED


class Solver(NamedTuple):
    """How constraints and contacts are solved.

    Attributes:
        iterations: Greatest number of sweeps over all rows, of the law "bullet"; at least 0.
        tolerance: Sweeps end when no row's squared change of velocity exceeds this.
        name: "sweeps", or "newton" of the laws that are solved until they converge; it follows from the law,
            and is not set.
    """

    iterations: int = 50
    tolerance: float = 1e-7
    name: str = "sweeps"

    @staticmethod
    def named(contact: str) -> str:
        """The name of the solver of a law of contacts."""
        return "newton" if contact in CONVERGED else "sweeps"

    def parameters(self) -> dict[str, float]:
        """The parameters of the engine.

        Raises:
            ValueError: A number is negative or not finite.
        """
        iterations, tolerance = int(self.iterations), float(finite(self.tolerance, "tolerance"))
        if iterations < 0 or tolerance < 0.0:
            raise ValueError(
                f"iterations and tolerance of a solver must be at least 0, not {iterations} and {tolerance}"
            )
        return {"solver_iterations": iterations, "solver_residual_threshold": tolerance}


def solver_from(given: object) -> Solver:
    """A solver from what users give.

    Raises:
        TypeError: It is neither a `Solver` nor a number of iterations.
    """
    if isinstance(given, Solver):
        return given
    if isinstance(given, int) and not isinstance(given, bool):
        return Solver(given)
    raise TypeError(
        "solver is a number of iterations, or carom.Solver(iterations=100, tolerance=1e-9), not "
        f"{given!r}; what is solved is chosen by contact='bullet', 'rigid' or 'compliant'"
    )
