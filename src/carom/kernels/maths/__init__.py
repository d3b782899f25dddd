"""Rotations, blocks and runs of numbers, minimum and maximum."""
