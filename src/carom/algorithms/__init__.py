"""Algorithms that need no step: kinematics, dynamics, momenta, and their derivatives."""

from carom.algorithms.answers import (
    CentroidalDynamics,
    ForwardDynamicsDerivatives,
    InverseDynamicsDerivatives,
    LinkMotionDerivatives,
    LinkMotions,
)
from carom.algorithms.bias import bias_forces, compute_coriolis_matrix, gravity_forces
from carom.algorithms.centroidal import (
    center_of_mass,
    centroidal_dynamics,
    centroidal_momentum,
    compute_centroidal_map,
    jacobian_center_of_mass,
    kinetic_energy,
    potential_energy,
)
from carom.algorithms.dynamics_derivatives import (
    forward_dynamics,
    forward_dynamics_derivatives,
    inverse_dynamics_derivatives,
)
from carom.algorithms.forward_kinematics import forward_kinematics
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.inverse_kinematics import InverseKinematicsResult, inverse_kinematics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.link_motions import link_motion_derivatives, link_motions
from carom.algorithms.mass_matrix import mass_matrix
from carom.algorithms.regressor import inertial_parameters, joint_torque_regressor
from carom.algorithms.tendon_inertia import tendon_bias_forces, tendon_inertia

__all__ = [
    "CentroidalDynamics",
    "ForwardDynamicsDerivatives",
    "InverseDynamicsDerivatives",
    "InverseKinematicsResult",
    "LinkMotionDerivatives",
    "LinkMotions",
    "bias_forces",
    "center_of_mass",
    "centroidal_dynamics",
    "centroidal_momentum",
    "compute_centroidal_map",
    "compute_coriolis_matrix",
    "forward_dynamics",
    "forward_dynamics_derivatives",
    "forward_kinematics",
    "gravity_forces",
    "inertial_parameters",
    "inverse_dynamics",
    "inverse_dynamics_derivatives",
    "inverse_kinematics",
    "jacobian",
    "jacobian_center_of_mass",
    "joint_torque_regressor",
    "kinetic_energy",
    "link_motion_derivatives",
    "link_motions",
    "mass_matrix",
    "potential_energy",
    "tendon_bias_forces",
    "tendon_inertia",
]
