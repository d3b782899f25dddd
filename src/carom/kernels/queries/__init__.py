"""Queries: ray tests, nearest points, lists and sums of contacts."""
