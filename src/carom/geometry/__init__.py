"""Shapes as numbers: convex hulls and other polyhedra. Knows nothing of robots or worlds."""
