"""Rotations, blocks of numbers, least and greatest entries."""
