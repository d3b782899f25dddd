"""Collision detection: bounding boxes, broad phase, narrow phase, contact manifolds."""
