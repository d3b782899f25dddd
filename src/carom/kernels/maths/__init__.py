"""Rotations, blocks of numbers, minimum and maximum."""
