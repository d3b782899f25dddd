"""Kernels that linearise steps."""
