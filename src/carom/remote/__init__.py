"""Calls from one process to another: frames on a socket, the values in them, and who may talk to whom."""
