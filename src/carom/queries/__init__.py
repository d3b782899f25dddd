"""Questions about a world: rays, nearest points, overlaps, contacts."""
