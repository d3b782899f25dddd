"""Inverse dynamics, mass matrices, Jacobians and stable PD control of one body."""
