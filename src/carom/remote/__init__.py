"""Calls from one process to another: frames on a socket, serialised values, and authentication by a key."""
