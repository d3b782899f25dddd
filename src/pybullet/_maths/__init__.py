"""Quaternions, transformations, camera matrices."""
