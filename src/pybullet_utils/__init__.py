"""Helpers that scripts import from PyBullet's companion package, in Carom."""
