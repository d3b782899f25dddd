"""Rays, nearest points, lists of contacts."""
