"""Saved worlds as files: a container, values in it, and the files they refer to."""
