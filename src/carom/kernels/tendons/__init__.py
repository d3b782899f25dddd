"""Tendons: their lengths, moment arms and rows."""
