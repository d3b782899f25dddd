"""Geoms of MJCF files: their shapes, looks and masses, and the meshes and height fields that they use."""
