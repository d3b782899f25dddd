"""Specifications of soft bodies: cloths, ropes and solids from meshes or from parameters."""
