"""Scenarios of soft bodies."""
