"""Soft bodies: nodes tied by springs and tetrahedra, and what they do to shapes."""
