"""Narrow phase: algorithms for contacts of two shapes, depending on their kinds."""
