"""Connecting, also to worlds of other processes."""
