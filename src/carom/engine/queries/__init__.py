"""Collision queries of a world: ray casts, nearest points, overlaps, contacts."""
