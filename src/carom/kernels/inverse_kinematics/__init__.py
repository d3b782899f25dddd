"""Inverse kinematics by damped least squares."""
