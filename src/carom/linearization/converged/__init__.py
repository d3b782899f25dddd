"""Derivatives of steps of the converged solver, as far as the host finds them."""
