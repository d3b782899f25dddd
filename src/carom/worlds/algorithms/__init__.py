"""Kinematics and dynamics of a body in many worlds, for states of one's choice."""
