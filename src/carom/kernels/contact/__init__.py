"""Collision detection: bounds, the broad phase, pairs of shapes, contacts that persist."""
