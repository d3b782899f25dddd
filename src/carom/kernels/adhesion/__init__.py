"""Adhesion: actuators that pull a link towards everything that touches it."""
