"""Constraints that have names, as handles: switched on and off, and asked for their force."""
