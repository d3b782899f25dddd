"""Algorithms that need no step: kinematics, inverse dynamics, Jacobians, mass matrices."""

from carom.algorithms.forward_kinematics import forward_kinematics
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.inverse_kinematics import InverseKinematicsResult, inverse_kinematics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.mass_matrix import mass_matrix

__all__ = [
    "InverseKinematicsResult",
    "forward_kinematics",
    "inverse_dynamics",
    "inverse_kinematics",
    "jacobian",
    "mass_matrix",
]
