"""Kernels of inverse kinematics: the joints of a chain, their steps, and the search for a pose."""
