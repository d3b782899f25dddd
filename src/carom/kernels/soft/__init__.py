"""Soft bodies: nodes connected by springs and tetrahedra, and their contacts with shapes."""
