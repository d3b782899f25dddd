"""Queries of a world: rays, nearest points, overlaps, contacts."""
