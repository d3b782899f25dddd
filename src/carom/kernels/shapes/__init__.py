"""Narrow phase: contacts of two shapes, by their kinds."""
