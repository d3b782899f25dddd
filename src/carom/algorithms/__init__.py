"""Questions about a robot that need no step: inverse dynamics, Jacobians, mass matrices."""

from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.mass_matrix import mass_matrix

__all__ = ["inverse_dynamics", "jacobian", "mass_matrix"]
