"""Derivatives of what integrators do beside the usual one."""
