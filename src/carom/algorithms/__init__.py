"""Algorithms that need no step: inverse dynamics and kinematics, Jacobians, mass matrices."""

from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.inverse_kinematics import inverse_kinematics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.mass_matrix import mass_matrix

__all__ = ["inverse_dynamics", "inverse_kinematics", "jacobian", "mass_matrix"]
