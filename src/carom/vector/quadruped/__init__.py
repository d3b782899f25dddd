"""A quadruped that follows velocity commands on random terrain, put together from terms."""
