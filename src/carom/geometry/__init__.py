"""Computational geometry: convex hulls and other polyhedra, independent of robots and worlds."""
