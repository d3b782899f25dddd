"""Keyframes: states of bodies, by name."""
