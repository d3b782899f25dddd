"""Contacts, nearest points, overlaps, rays, collision filters."""
