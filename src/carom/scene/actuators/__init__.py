"""Actuators of a body, as handles: controls, forces and parameters by name."""
