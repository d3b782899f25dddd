"""Environments of the Minitaur, with sensor latency as on the real robot."""
