"""Inverse dynamics and kinematics, Jacobians, mass matrices."""
