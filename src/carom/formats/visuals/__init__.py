"""Mesh files for drawing: normals, texture coordinates and materials."""
