"""Environments of the Minitaur with sensors that lag, as on the real robot."""
