"""Device code of sensors: what they measure, when they are read."""
