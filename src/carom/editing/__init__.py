"""Descriptions of scenes that can be changed before they are compiled, and writing them as files."""
