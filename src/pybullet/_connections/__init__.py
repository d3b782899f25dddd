"""Connections, also to worlds of other processes."""
