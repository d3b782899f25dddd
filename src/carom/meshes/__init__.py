"""Meshes: triangles from OBJ, STL and DAE files."""

from carom.meshes.distance_field import read_field_bounds
from carom.meshes.part import MeshPart
from carom.meshes.reader import read_mesh

__all__ = ["MeshPart", "read_field_bounds", "read_mesh"]
