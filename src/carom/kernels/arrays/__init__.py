"""Elementwise arithmetic on arrays that stay on a device."""
