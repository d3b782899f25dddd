"""Joints, motors and constraints."""
