"""Stepping, engine parameters, states."""
